// Axes: round steps, logarithms, and numbers as short as they can be while they differ.

function roundStep(span, count) {
  const rough = span / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const times = [1, 2, 2.5, 5, 10].find((factor) => factor * power >= rough * 0.999);
  return times * power;
}

function ticks(low, high, count) {
  const step = roundStep(high - low || 1, count);
  const found = [];
  for (let index = Math.ceil(low / step - 1e-9); index * step <= high + step * 1e-9; index += 1) {
    found.push(Number((index * step).toPrecision(12)));
  }
  return found;
}

function logTicks(low, high) {
  const found = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
    for (const times of [1, 2, 5]) {
      const value = Number((times * 10 ** power).toPrecision(12));
      if (value >= low * 0.999 && value <= high * 1.001) found.push(value);
    }
  }
  return found;
}

// At most `digits` significant digits, without needless zeros.
function short(value, digits = 5) {
  if (!Number.isFinite(value)) return '';
  if (value !== 0 && (Math.abs(value) < 1e-4 || Math.abs(value) >= 1e7)) return value.toExponential(2);
  return String(Number(value.toPrecision(digits)));
}

// A map from values to pixels.
function scale(low, high, start, end, isLog) {
  const on = isLog ? Math.log10 : (value) => value;
  const span = on(high) - on(low) || 1;
  const map = (value) => start + ((on(value) - on(low)) / span) * (end - start);
  map.low = low;
  map.high = high;
  return map;
}

// Room around the values so that lines do not lie on the frame.
function padded([low, high], share) {
  if (!(high > low)) {
    const half = Math.abs(low) * 0.1 || 0.5;
    return [low - half, high + half];
  }
  const room = (high - low) * share;
  return [low - room, high + room];
}
