// What is wrong, and what was run.

function noticeView(notice, run, isSeveral) {
  const of = isSeveral ? element('span', { class: 'of' }, `${run.name}: `) : null;
  const items = notice.items.length ? element('ul', {}, notice.items.map((item) => element('li', {}, item))) : null;
  return element('div', { class: `notice ${notice.level}` }, element('b', {}, notice.level), of, notice.text, items);
}

function runCard(run) {
  const highlights = run.highlights.map(({ label, value }) =>
    element('div', {}, element('div', { class: 'value' }, value), element('div', { class: 'label' }, label)),
  );
  const facts = run.facts.map(({ label, value }) => element('div', {}, element('dt', {}, label), element('dd', {}, value)));
  return element(
    'section',
    { class: 'card run' },
    element('h3', { class: 'run-name' }, run.name),
    element('p', { class: 'kind' }, run.kind),
    highlights.length ? element('div', { class: 'highlights' }, highlights) : null,
    element('dl', {}, facts),
  );
}

function stillView(picture, run) {
  const block = JSON.parse(document.getElementById(picture.block).textContent);
  if (!block[0]) return null;
  const image = element('img', { alt: picture.name, src: `data:image/jpeg;base64,${block[0]}` });
  const of = run.beside ? element('span', { class: 'of' }, ` ${run.name}`) : null;
  return element('section', { class: 'card still' }, element('h3', {}, picture.name, of), image);
}
