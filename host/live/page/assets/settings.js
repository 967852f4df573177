// What the person at the page chooses.
const chosen = (name) => document.querySelector(`input[name="${name}"]:checked`).value;
const isShown = (name) => element(`show-${name}`).checked;

// Particles, arm and the shoulder's distance, as they stand.
function settings() {
  return { side: chosen('side'), particles: Number(element('particles').value), distance: Number(element('distance').value) };
}

function tellSettings() {
  element('particles-shown').textContent = element('particles').value;
  element('distance-shown').textContent = `${Number(element('distance').value).toFixed(2)} m`;
}

function setDistance(metres) {
  element('distance').value = metres;
  tellSettings();
}

function setSide(side) {
  document.querySelector(`input[name="side"][value="${side}"]`).checked = true;
}

// Rows of a list of names and values.
function showRows(list, rows) {
  list.replaceChildren(...Object.entries(rows).flatMap(([name, value]) => [made('dt', name), made('dd', value)]));
}
