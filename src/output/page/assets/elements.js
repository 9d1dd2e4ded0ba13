// Building and finding elements.

/** An element with attributes (`on...` are listeners, `class`, `text`) and children (elements or text; null is left out). */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

/** A section with a heading; null without content. */
function section(title, ...content) {
  const kept = content.flat().filter((child) => child !== null && child !== undefined);
  return kept.length === 0 ? null : element("section", {}, element("h3", {}, title), ...kept);
}

/** A table from a header and rows of cells. A cell is text, an element, or `{ text, class }`. */
function table(header, rows, attributes = {}) {
  const cell = (tag) => (content) => {
    const isStyled = content !== null && typeof content === "object" && !(content instanceof Node);
    return element(tag, isStyled ? { class: content.class } : {}, isStyled ? content.text : content);
  };
  const body = rows.map((row) => element("tr", {}, row.map(cell("td"))));
  const head = element("thead", {}, element("tr", {}, header.map(cell("th"))));
  return element("div", { class: "wide" }, element("table", attributes, head, element("tbody", {}, body)));
}

/** Calls `draw` now and whenever the width of `box` changes. */
function whenResized(box, draw) {
  let width = 0;
  new ResizeObserver(() => {
    if (box.clientWidth > 0 && box.clientWidth !== width) {
      width = box.clientWidth;
      draw(width);
    }
  }).observe(box);
}
