// The box with values beside the pointer.

function showPointer(event, heading, rows) {
  const box = document.getElementById('pointer');
  box.replaceChildren(
    element('div', { class: 'x' }, heading),
    ...rows.map(({ series, value, raw, rawNumber }) =>
      element(
        'div',
        { class: 'row', 'data-series': series.name, 'data-raw': rawNumber },
        element('span', { style: { color: colourOf(series.colour) } }, series.name),
        element('span', {}, value, raw ? element('span', { class: 'raw' }, `  ${raw}`) : null),
      ),
    ),
  );
  box.hidden = false;
  const [width, height] = [box.offsetWidth, box.offsetHeight];
  const left = event.clientX + 16 + width < window.innerWidth ? event.clientX + 16 : event.clientX - 16 - width;
  const top = Math.min(Math.max(event.clientY - height / 2, 4), window.innerHeight - height - 4);
  box.style.left = `${Math.max(left, 4)}px`;
  box.style.top = `${top}px`;
}

function hidePointer() {
  document.getElementById('pointer').hidden = true;
}
