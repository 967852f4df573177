// A skeleton drawn from the columns of tables, for one frame at a time.

class FigureView {
  constructor(figure, tables) {
    this.figure = figure;
    this.bones = figure.bones.flatMap((bone) => {
      const table = tables.get(bone.table);
      if (!table) return [];
      const ends = [bone.from, bone.to].map((end) => end.map((column) => table.index(column)));
      return ends.flat().includes(-1) ? [] : [{ bone, table, ends }];
    });
    this.bounds = figure.bounds || this.ownBounds();
    this.svg = svg('svg', { role: 'img', 'aria-label': figure.title });
    const [left, low, right, high] = this.bounds;
    const most = 460;
    this.scale = most / Math.max(right - left, high - low, 1e-9);
    this.size = [(right - left) * this.scale, (high - low) * this.scale];
    this.svg.setAttribute('viewBox', `0 0 ${this.size[0].toFixed(1)} ${this.size[1].toFixed(1)}`);
    this.svg.style.maxHeight = '440px';
    this.svg.style.width = '100%';
    this.node = element('figure', {}, this.svg, element('figcaption', {}, figure.title, ...this.sides()));
  }

  // What the colours stand for.
  sides() {
    const used = new Set(this.bones.filter(({ bone }) => !bone.truth).map(({ bone }) => bone.colour));
    const named = ['left', 'right'].filter((side) => used.has(side));
    return named.map((side) => element('span', { style: { color: colourOf(side) } }, `  \u25cf ${side}`));
  }

  ownBounds() {
    const values = [[], []];
    for (const { bone, table, ends } of this.bones) {
      for (const row of table.rowsWhere(bone.only)) {
        for (const end of ends) end.forEach((index, axis) => values[axis].push(numberOf(row[index])));
      }
    }
    const [xs, ys] = values.map((list) => padded(extent(list) || [0, 1], 0.06));
    return [xs[0], ys[0], xs[1], ys[1]];
  }

  place([x, y]) {
    const [left, low, , high] = this.bounds;
    return [(x - left) * this.scale, (this.figure.y_down ? y - low : high - y) * this.scale];
  }

  show(frame) {
    const parts = [svg('rect', { class: 'sheet', width: this.size[0], height: this.size[1] })];
    const joints = [];
    for (const { bone, table, ends } of this.bones) {
      const fits = (row) => bone.only.every(([column, value]) => row[table.index(column)] === value);
      const row = table.rowsOfFrame(frame).find(fits);
      if (!row) continue;
      const [from, to] = ends.map((end) => end.map((index) => numberOf(row[index])));
      if (![...from, ...to].every(Number.isFinite)) continue;
      const [a, b] = [this.place(from), this.place(to)];
      const style = { '--colour': colourOf(bone.colour) };
      const d = `M${a[0].toFixed(1)} ${a[1].toFixed(1)}L${b[0].toFixed(1)} ${b[1].toFixed(1)}`;
      parts.push(svg('path', { class: `bone${bone.truth ? ' truth' : ''}`, d, ...style }));
      if (!bone.truth) joints.push(svg('circle', { class: 'joint', cx: b[0].toFixed(1), cy: b[1].toFixed(1), r: 4, ...style }));
    }
    this.svg.replaceChildren(...parts, ...joints);
  }
}
