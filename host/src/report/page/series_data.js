// Points of series: numbers to draw, and the cells that they come from.

function numberOf(cell) {
  return cell === undefined || cell.trim() === '' ? NaN : Number(cell);
}

function seriesPoints(series, tables) {
  const table = tables.get(series.table);
  if (!table) return [];
  const [x, y, frame] = [table.index(series.x), table.index(series.y), table.index('frame')];
  const [xTimes, yTimes] = [series.x_times || 1, series.y_times || 1];
  const band = bandOf(series, table);
  const points = [];
  for (const row of table.rowsWhere(series.only)) {
    const point = {
      name: row[x],
      x: numberOf(row[x]) * xTimes,
      y: numberOf(row[y]) * yTimes,
      xCell: row[x],
      yCell: row[y],
      frame: frame < 0 ? undefined : row[frame],
    };
    if (band) {
      const [low, high] = band(row);
      point.low = low * yTimes;
      point.high = high * yTimes;
    }
    points.push(point);
  }
  return points;
}

// What gives the edges of the band of a row, in the units of the table.
function bandOf(series, table) {
  if (!series.band) return null;
  const y = table.index(series.y);
  if ('half' in series.band) {
    const [half, times] = [table.index(series.band.half), series.band.times];
    if (half < 0) return null;
    return (row) => [-1, 1].map((sign) => numberOf(row[y]) + sign * times * numberOf(row[half]));
  }
  const [low, high] = [table.index(series.band.low), table.index(series.band.high)];
  return low < 0 || high < 0 ? null : (row) => [numberOf(row[low]), numberOf(row[high])];
}

function isThere(point) {
  return Number.isFinite(point.x) && Number.isFinite(point.y);
}

// The middle one of the steps from frame to frame.
function usualStep(points) {
  const steps = points.slice(1).map((point, index) => numberOf(point.frame) - numberOf(points[index].frame));
  const known = steps.filter((step) => step > 0).sort((a, b) => a - b);
  return known[Math.floor(known.length / 2)];
}

// Stretches without a gap, frames that have no row, or a jump of `breaks` and more.
function stretches(points, breaks) {
  const step = usualStep(points);
  const found = [];
  let current = [];
  for (const point of points) {
    const before = current[current.length - 1];
    const leavesOut = before && numberOf(point.frame) - numberOf(before.frame) > step;
    const jumps = leavesOut || (before && breaks && Math.abs(point.y - before.y) >= breaks);
    if ((!isThere(point) || jumps) && current.length) {
      found.push(current);
      current = [];
    }
    if (isThere(point)) current.push(point);
  }
  if (current.length) found.push(current);
  return found;
}

// Of very many points the least and greatest of each piece: peaks stay.
function thinned(points, most) {
  if (points.length <= most) return points;
  const length = Math.ceil((2 * points.length) / most);
  const kept = [];
  for (let start = 0; start < points.length; start += length) {
    const piece = points.slice(start, start + length);
    const least = piece.reduce((a, b) => (b.y < a.y ? b : a));
    const most_ = piece.reduce((a, b) => (b.y > a.y ? b : a));
    kept.push(...(piece.indexOf(least) <= piece.indexOf(most_) ? [least, most_] : [most_, least]));
  }
  return kept;
}

function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return low <= high ? [low, high] : null;
}
