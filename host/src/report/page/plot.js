// A plot with lines, bands and dots. Its legend shows the values of the player's frame; the pointer those beneath it.

const MARGIN = { left: 62, right: 14, top: 10, bottom: 40 };
const MAX_POINTS = 4000;

class PlotView {
  constructor(plot, run, tables, onFrame) {
    Object.assign(this, { plot, run, tables, onFrame });
    this.hidden = new Set();
    // Where both axes are places or values, a point is found by both.
    this.byBoth = plot.image_axes || plot.pairs;
    this.lines = plot.series.map((series) => ({ series, points: seriesPoints(series, tables) }));
    this.svg = svg('svg', { role: 'img', 'aria-label': plot.title });
    this.svg.addEventListener('pointermove', (event) => this.point(event));
    this.svg.addEventListener('pointerleave', () => this.leave());
    this.svg.addEventListener('click', (event) => this.choose(event));
    this.legend = element('div', { class: 'legend' });
    const classes = `plot card${plot.over_frames ? ' over-frames' : ''}`;
    this.node = element(
      'section',
      { class: classes, 'data-plot': plot.id },
      element('div', { class: 'head' }, element('h3', {}, plot.title), run.beside ? element('span', { class: 'of' }, run.name) : null),
      element('p', { class: 'reading' }, plot.reading),
      this.svg,
      this.legend,
    );
    this.drawLegend();
  }

  // Least and greatest x and y of what is drawn.
  range() {
    const points = this.lines.flatMap((line) => line.points).filter(isThere);
    const { bounds } = this.plot;
    const xs = extent(points.map((point) => point.x));
    const ys = extent(points.flatMap((point) => [point.y, point.low, point.high]).concat(this.plot.from_zero ? [0] : []));
    if (!bounds) return { xs, ys };
    return { xs: extent([bounds[0], bounds[2], ...(xs || [])]), ys: extent([bounds[1], bounds[3], ...(ys || [])]) };
  }

  // Draws with axes that hold `xs` and `ys`, the ranges of all plots that stand beside it.
  draw(xs, ys) {
    this.shared = [xs, ys];
    const width = Math.max(this.svg.clientWidth || this.node.clientWidth - 34, 260);
    const room = [width - MARGIN.left - MARGIN.right, 200];
    const [low, high] = this.plot.from_zero && ys[0] >= 0 ? [0, ys[1] + (ys[1] - ys[0]) * 0.06 || 1] : padded(ys, 0.05);
    let xRange = this.plot.x_log ? [xs[0] * 0.9, xs[1] * 1.1] : xs[1] > xs[0] ? xs : padded(xs, 0);
    let yRange = [low, high];
    if (this.plot.image_axes) {
      [xRange, yRange] = [xs, ys];
      const shape = (ys[1] - ys[0]) / (xs[1] - xs[0] || 1);
      room[1] = Math.min(Math.max(room[0] * shape, 120), 420);
      const wanted = room[1] / shape;
      if (wanted < room[0]) room[0] = wanted;
    }
    const height = room[1] + MARGIN.top + MARGIN.bottom;
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.svg.style.height = `${height}px`;
    this.x = scale(...xRange, MARGIN.left, MARGIN.left + room[0], this.plot.x_log);
    const [top, bottom] = [MARGIN.top, MARGIN.top + room[1]];
    this.y = this.plot.image_axes ? scale(...yRange, top, bottom) : scale(...yRange, bottom, top);
    this.area = { left: MARGIN.left, right: MARGIN.left + room[0], top, bottom };
    this.cursor = svg('g', { class: 'cursor-group' });
    this.marks = svg('g', {});
    this.svg.replaceChildren(...this.drawShades(), ...this.drawAxes(room), ...this.drawLines(), this.cursor, this.marks);
    if (this.frame !== undefined) this.showFrame(this.frame);
  }

  drawShades() {
    const found = [];
    for (const shade of this.plot.shades) {
      const table = this.tables.get(shade.table);
      if (!table) continue;
      const [column, times] = [table.index(shade.x), shade.x_times || 1];
      const all = [...new Set(table.rows.map((row) => numberOf(row[column]) * times))].sort((a, b) => a - b);
      const step = all.length > 1 ? (all[all.length - 1] - all[0]) / (all.length - 1) : 1;
      const { left, right, top, bottom } = this.area;
      let d = '';
      for (const row of table.rowsWhere(shade.only)) {
        const x = numberOf(row[column]) * times;
        const [from, to] = [this.x(x - step / 2), this.x(x + step / 2)].map((at) => Math.min(Math.max(at, left), right));
        d += `M${from.toFixed(1)} ${top}H${to.toFixed(1)}V${bottom}H${from.toFixed(1)}Z`;
      }
      found.push(svg('path', { class: 'shade', d }, svg('title', {}, shade.name)));
    }
    return found;
  }

  drawAxes([width, height]) {
    const { left, right, top, bottom } = this.area;
    const parts = [];
    const xs = this.plot.x_log ? logTicks(this.x.low, this.x.high) : ticks(this.x.low, this.x.high, width / 80);
    for (const value of xs) {
      const at = this.x(value);
      parts.push(svg('line', { class: 'gridline', x1: at, x2: at, y1: top, y2: bottom }));
      parts.push(svg('text', { x: at, y: bottom + 16, 'text-anchor': 'middle' }, short(value)));
    }
    for (const value of ticks(this.y.low, this.y.high, height / 42)) {
      const at = this.y(value);
      parts.push(svg('line', { class: 'gridline', x1: left, x2: right, y1: at, y2: at }));
      parts.push(svg('text', { x: left - 7, y: at + 4, 'text-anchor': 'end' }, short(value)));
    }
    parts.push(svg('path', { class: 'axis', fill: 'none', d: `M${left} ${top}V${bottom}H${right}` }));
    parts.push(svg('text', { class: 'label', x: (left + right) / 2, y: bottom + 34, 'text-anchor': 'middle' }, this.plot.x_label));
    const turn = `translate(14 ${(top + bottom) / 2}) rotate(-90)`;
    parts.push(svg('text', { class: 'label', transform: turn, 'text-anchor': 'middle' }, this.plot.y_label));
    return parts;
  }

  drawLines() {
    const at = (point, value) => `${this.x(point.x).toFixed(1)} ${this.y(value).toFixed(1)}`;
    const [bands, lines] = [[], []];
    for (const { series, points } of this.lines) {
      if (this.hidden.has(series.name)) continue;
      const style = { '--colour': colourOf(series.colour) };
      for (const whole of stretches(points, series.breaks)) {
        const stretch = this.byBoth ? whole : thinned(whole, MAX_POINTS);
        const banded = stretch.filter((point) => Number.isFinite(point.low) && Number.isFinite(point.high));
        if (banded.length > 1) {
          const back = [...banded].reverse();
          const d = `M${banded.map((p) => at(p, p.high)).join('L')}L${back.map((p) => at(p, p.low)).join('L')}Z`;
          bands.push(svg('path', { class: 'band', d, ...style }));
        }
        if (series.style !== 'dots') {
          const dashes = series.style === 'dashes' ? ' dashes' : '';
          lines.push(svg('path', { class: `line${dashes}`, d: `M${stretch.map((p) => at(p, p.y)).join('L')}`, ...style }));
        }
        if (series.style === 'dots' || series.style === 'points' || stretch.length === 1) {
          const radius = stretch.length > 60 ? 1.6 : 3;
          const d = stretch
            .map((p) => `M${at(p, p.y)}m-${radius} 0a${radius} ${radius} 0 1 0 ${2 * radius} 0a${radius} ${radius} 0 1 0 -${2 * radius} 0`)
            .join('');
          lines.push(svg('path', { class: 'dot', d, ...style }));
        }
      }
    }
    return [...bands, ...lines];
  }

  drawLegend() {
    this.at = new Map();
    const entries = this.lines.map(({ series }) => {
      const value = element('span', { class: 'at' });
      this.at.set(series, value);
      const dashed = series.style === 'dashes' ? ' dashes' : '';
      const sign = series.style === 'dots' ? svg('circle', { class: 'dot', cx: 11, cy: 5, r: 3.5 }) : svg('path', { class: `line${dashed}`, d: 'M1 5H21' });
      const swatch = svg('svg', { class: 'swatch', viewBox: '0 0 22 10', '--colour': colourOf(series.colour) }, sign);
      const button = element('button', { 'aria-pressed': 'true', title: 'show or hide' }, swatch, series.name, value);
      button.addEventListener('click', () => this.toggle(series.name, button));
      return button;
    });
    const shades = this.plot.shades.map((shade) =>
      element('span', { class: 'at' }, svg('svg', { class: 'swatch', viewBox: '0 0 22 10' }, svg('rect', { class: 'shade', width: 22, height: 10 })), ` ${shade.name}`),
    );
    this.legend.replaceChildren(...entries, ...shades);
  }

  toggle(name, button) {
    if (this.hidden.has(name)) this.hidden.delete(name);
    else this.hidden.add(name);
    button.setAttribute('aria-pressed', String(!this.hidden.has(name)));
    this.draw(...this.shared);
  }

  visible() {
    return this.lines.filter(({ series }) => !this.hidden.has(series.name));
  }

  // Marks the frame of the player.
  showFrame(frame) {
    this.frame = frame;
    if (!this.plot.over_frames || !this.cursor) return;
    const marks = [];
    let at = null;
    for (const line of this.lines) {
      if (!line.byFrame) line.byFrame = new Map(line.points.map((point) => [point.frame, point]));
      const point = line.byFrame.get(frame);
      this.at.get(line.series).textContent = point && isThere(point) ? short(point.y, 4) : '–';
      if (!point || !Number.isFinite(point.x)) continue;
      at = this.x(point.x);
      if (isThere(point) && !this.hidden.has(line.series.name)) {
        const place = { cx: at, cy: this.y(point.y), r: this.byBoth ? 6 : 3.5 };
        marks.push(svg('circle', { class: 'mark', ...place, '--colour': colourOf(line.series.colour) }));
      }
    }
    const { top, bottom } = this.area;
    const line = at === null || this.byBoth ? [] : [svg('line', { class: 'cursor', x1: at, x2: at, y1: top, y2: bottom })];
    this.cursor.replaceChildren(...line, ...marks);
  }

  // The nearest point of each line, by x alone or, where both axes are places, of one line by both.
  nearest(event) {
    const box = this.svg.getBoundingClientRect();
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    let best = null;
    for (const { series, points } of this.visible()) {
      for (const point of points) {
        if (!isThere(point)) continue;
        const [dx, dy] = [this.x(point.x) - px, this.y(point.y) - py];
        const distance = this.byBoth ? dx * dx + dy * dy : Math.abs(dx);
        if (!best || distance < best.distance) best = { distance, point, series };
      }
    }
    if (!best) return [];
    if (this.byBoth) return [best];
    // Tables of one run may round times differently; the frame number joins what belongs together.
    const { x, frame } = best.point;
    const belongs = (other) => (frame !== undefined && other.frame !== undefined ? other.frame === frame : other.x === x);
    const beside = ({ series, points }) => {
      const point = points.find((other) => belongs(other) && isThere(other));
      return point ? [{ series, point }] : [];
    };
    return this.visible().flatMap(beside);
  }

  point(event) {
    if (!this.area) return;
    const found = this.nearest(event);
    if (!found.length) return;
    const unit = (label) => label.split(', ').slice(1).join(', ');
    const { point } = found[0];
    const [xName] = this.plot.x_label.split(', ');
    const frame = this.plot.over_frames && point.frame !== undefined ? `frame ${point.frame}, ` : '';
    const heading = this.plot.image_axes
      ? `${frame}${xName} ${short(point.x)}`
      : `${frame}${xName} ${short(point.x)} ${unit(this.plot.x_label)}`;
    const yUnit = unit(this.plot.y_label);
    const rows = found.map((one) => {
      const scaled = (one.series.y_times || 1) !== 1;
      const band = Number.isFinite(one.point.low) ? `  (${short(one.point.low, 4)} to ${short(one.point.high, 4)})` : '';
      const value = scaled ? `${short(one.point.y)} ${yUnit}${band}` : `${one.point.yCell} ${yUnit}${band}`;
      return { series: one.series, value, raw: scaled ? `${one.point.yCell} in the table` : '', rawNumber: one.point.yCell };
    });
    showPointer(event, heading, rows);
    const marks = found.map((one) =>
      svg('circle', { class: 'mark', cx: this.x(one.point.x), cy: this.y(one.point.y), r: 4.5, '--colour': colourOf(one.series.colour) }),
    );
    this.marks.replaceChildren(...marks);
    this.marks.setAttribute('data-frame', point.frame ?? '');
  }

  leave() {
    hidePointer();
    if (this.marks) this.marks.replaceChildren();
  }

  choose(event) {
    if (!this.plot.over_frames || !this.area) return;
    const [first] = this.nearest(event);
    if (first && first.point.frame !== undefined) this.onFrame(first.point.frame);
  }
}
