// Tables of the page: CSV text, parsed when it is first needed. Cells stay the text that they are in the file.

function parseCsv(text) {
  const rows = [];
  let row = [];
  let at = 0;
  while (at < text.length) {
    let cell;
    if (text[at] === '"') {
      let end = at + 1;
      cell = '';
      for (;;) {
        const quote = text.indexOf('"', end);
        cell += text.slice(end, quote);
        end = quote + 1;
        if (text[end] !== '"') break;
        cell += '"';
        end += 1;
      }
      at = end;
    } else {
      let end = at;
      while (end < text.length && text[end] !== ',' && text[end] !== '\n') end += 1;
      cell = text.slice(at, end);
      at = end;
    }
    row.push(cell);
    if (at >= text.length || text[at] === '\n') {
      rows.push(row);
      row = [];
    } else if (at + 1 === text.length) {
      row.push('');
    }
    at += 1;
  }
  return rows;
}

class TableData {
  constructor(table) {
    this.name = table.name;
    this.title = table.title;
    this.csv = table.csv;
    this.count = table.rows;
  }

  get rows() {
    this.parse();
    return this.parsed;
  }

  get columns() {
    this.parse();
    return this.heading;
  }

  parse() {
    if (this.parsed) return;
    const [heading, ...rows] = parseCsv(this.csv);
    this.heading = heading || [];
    this.parsed = rows;
  }

  index(column) {
    return this.columns.indexOf(column);
  }

  // Rows that hold what `only` asks for, a list of [column, value].
  rowsWhere(only) {
    const wanted = only.map(([column, value]) => [this.index(column), value]);
    return this.rows.filter((row) => wanted.every(([index, value]) => row[index] === value));
  }

  // Rows by their cell in the column `frame`.
  rowsOfFrame(frame) {
    if (!this.byFrame) {
      this.byFrame = new Map();
      const index = this.index('frame');
      for (const row of index < 0 ? [] : this.rows) {
        if (!this.byFrame.has(row[index])) this.byFrame.set(row[index], []);
        this.byFrame.get(row[index]).push(row);
      }
    }
    return this.byFrame.get(frame) || [];
  }
}
