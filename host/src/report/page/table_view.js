// Tables to read and to take along as CSV.

const FIRST_ROWS = 50;

async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = element('textarea', { style: { position: 'fixed', opacity: 0 } });
    area.value = text;
    document.body.append(area);
    area.select();
    const copied = document.execCommand('copy');
    area.remove();
    return copied;
  }
}

function saveText(name, text) {
  const link = element('a', { href: URL.createObjectURL(new Blob([text], { type: 'text/csv' })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function tableNode(table, most) {
  const first = table.rows.slice(0, most);
  const isText = table.columns.map((_, index) => first.some((row) => row[index] !== '' && !Number.isFinite(Number(row[index]))));
  const kind = (index) => (isText[index] ? 'text' : null);
  const heading = element('tr', {}, table.columns.map((name, index) => element('th', { class: kind(index) }, name)));
  const cell = (text, index) => element('td', { class: text.length > 60 ? 'text long' : kind(index) }, text);
  return element('table', {}, element('thead', {}, heading), element('tbody', {}, first.map((row) => element('tr', {}, row.map(cell)))));
}

function tableView(table) {
  const body = element('div', { class: 'table-body' });
  const copy = element('button', { 'data-copy': table.name }, 'Copy as CSV');
  copy.addEventListener('click', async () => {
    copy.textContent = (await copyText(table.csv)) ? 'Copied' : 'The browser refused';
    setTimeout(() => (copy.textContent = 'Copy as CSV'), 1500);
  });
  const name = table.name.endsWith('.csv') ? table.name : `${table.name}.csv`;
  const save = element('button', {}, 'Save');
  save.addEventListener('click', () => saveText(name, table.csv));
  const tools = element('div', { class: 'table-tools' }, copy, save);
  if (table.count > FIRST_ROWS) {
    const all = element('button', {}, `Show all ${table.count} rows`);
    all.addEventListener('click', () => {
      body.replaceChildren(tableNode(table, table.count));
      all.remove();
    });
    tools.append(all);
  }
  const size = element('span', { class: 'size' }, `${table.title}, ${table.count} rows`);
  const node = element('details', { 'data-table': table.name }, element('summary', {}, element('b', {}, table.name), size), tools, body);
  node.addEventListener('toggle', () => {
    if (node.open && !body.firstChild) body.append(tableNode(table, FIRST_ROWS));
  });
  return node;
}
