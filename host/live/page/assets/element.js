// The page's elements, by id.
const element = (id) => document.getElementById(id);

// A new element with a text and attributes.
function made(tag, text, attributes = {}) {
  const node = document.createElement(tag);
  node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

// Bytes of a base64 text.
const bytesOf = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

// A canvas that is not in the page.
function hiddenCanvas(width, height) {
  return Object.assign(document.createElement('canvas'), { width, height });
}
