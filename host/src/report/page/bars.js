// Bars, one for each row of a table, with whiskers for the band.

class BarsView {
  constructor(plot, run, tables) {
    this.plot = plot;
    this.lines = plot.series.map((series) => ({ series, points: seriesPoints(series, tables) }));
    this.svg = svg('svg', { role: 'img', 'aria-label': plot.title });
    this.svg.addEventListener('pointerleave', hidePointer);
    this.node = element(
      'section',
      { class: 'plot card', 'data-plot': plot.id },
      element('div', { class: 'head' }, element('h3', {}, plot.title), run.beside ? element('span', { class: 'of' }, run.name) : null),
      element('p', { class: 'reading' }, plot.reading),
      this.svg,
    );
  }

  range() {
    const points = this.lines.flatMap((line) => line.points);
    return { xs: [0, 1], ys: extent(points.flatMap((point) => [0, point.y, point.low, point.high])) };
  }

  draw(xs, ys) {
    this.shared = [xs, ys];
    const bars = this.lines.flatMap(({ series, points }) => points.filter((p) => Number.isFinite(p.y)).map((point) => ({ series, point })));
    const width = Math.max(this.svg.clientWidth || this.node.clientWidth - 34, 260);
    const longest = Math.max(...bars.map(({ point }) => point.name.length), 4);
    const left = Math.min(longest * 6.6 + 14, width * 0.45);
    const [step, top] = [24, 8];
    const bottom = top + bars.length * step;
    const height = bottom + 42;
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.svg.style.height = `${height}px`;
    const high = ys[1] + (ys[1] - ys[0]) * 0.06 || 1;
    const x = scale(Math.min(ys[0], 0), high, left, width - 14);
    const parts = ticks(x.low, x.high, (width - left) / 80).flatMap((value) => [
      svg('line', { class: 'gridline', x1: x(value), x2: x(value), y1: top, y2: bottom }),
      svg('text', { x: x(value), y: bottom + 16, 'text-anchor': 'middle' }, short(value)),
    ]);
    parts.push(svg('text', { class: 'label', x: (left + width) / 2, y: bottom + 34, 'text-anchor': 'middle' }, this.plot.y_label));
    bars.forEach(({ series, point }, index) => {
      const y = top + index * step;
      const [from, to] = [x(0), x(point.y)].sort((a, b) => a - b);
      const bar = svg('rect', { class: 'bar', x: from, y: y + 4, width: Math.max(to - from, 1), height: step - 8, rx: 2, '--colour': colourOf(series.colour) });
      const line = svg('text', { class: 'label', x: left - 8, y: y + 16, 'text-anchor': 'end' }, point.name);
      parts.push(line, bar);
      if (Number.isFinite(point.low)) {
        const [low, end, middle] = [x(point.low), x(point.high), y + step / 2];
        parts.push(svg('path', { class: 'whisker', fill: 'none', d: `M${low} ${middle}H${end}M${low} ${middle - 4}v8M${end} ${middle - 4}v8` }));
      }
      const hit = svg('rect', { x: 0, y, width, height: step, fill: 'transparent' });
      hit.addEventListener('pointermove', (event) => {
        const band = Number.isFinite(point.low) ? `  (${short(point.low, 4)} to ${short(point.high, 4)})` : '';
        showPointer(event, point.name, [{ series, value: `${point.yCell}${band}`, raw: '', rawNumber: point.yCell }]);
      });
      parts.push(hit);
    });
    this.svg.replaceChildren(...parts);
  }

  showFrame() {}
}
