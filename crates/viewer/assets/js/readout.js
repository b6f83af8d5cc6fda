// Values of one cell for every method: the cell under the mouse, or the selected one.

/** Where the values are from. */
function readoutCell(v) {
  const { width, height } = v.view.size(v);
  const hover = state.hover;
  const inside = hover && hover.x < width && hover.y < height;
  return inside ? hover : v.view.cell(v);
}

/** Value and standard error of a cell as text. */
function cellTexts(v, cube, cell) {
  const { view } = v;
  if (!view.colour) {
    const value = view.read(v, cube, cell.x, cell.y);
    const judgesItself = view.judges && cube === v.reference;
    const text = view.scale(v).text ?? ((number) => digits(number));
    return { parts: [judgesItself ? "–" : Number.isNaN(value) ? "–" : text(value)], error: "" };
  }
  const out = [0, 0, 0];
  view.read(v, cube, cell.x, cell.y, out);
  const parts = out.slice(0, cube.channels).map((value) => (Number.isNaN(value) ? "not finite" : digits(value)));
  const error = view.error(v, cube, cell.x, cell.y);
  return { parts, error: error === undefined || Number.isNaN(cube.interval * error) ? "" : `± ${digits(cube.interval * error, 2)}` };
}

function drawReadout(v) {
  const { view } = v;
  const cell = readoutCell(v);
  const place = { x: state.x, y: state.y, bin: state.bin, ...view.place(v, cell.x, cell.y) };
  const unit = view.unit(v);
  const time = view.kind !== "image" || view.moves ? `, ${v.timeOfBin(place.bin)}` : "";
  byId("readout-title").textContent = state.hover ? "Under the cursor" : "Selected pixel";
  byId("where").textContent = `column ${v.column(place.x)}, row ${v.row(place.y)}${time}${unit ? ` · ${unit}` : ""}`;
  const head = view.colour && v.channels === 3 ? ["R", "G", "B"] : ["value"];
  const rows = v.cubes.map((cube, index) => ({ cube, index, ...cellTexts(v, cube, cell) }));
  const errors = rows.some((row) => row.error);
  const header = element("tr", {}, [
    element("th", { text: "method", scope: "col" }),
    ...head.map((text) => element("th", { text, scope: "col", className: "number" })),
    ...(errors ? [element("th", { text: v.channels === 3 ? "± 95 % (lum.)" : "± 95 %", scope: "col", className: "number" })] : []),
  ]);
  const body = rows.map(({ cube, index, parts, error }) => element("tr", { className: index === state.method ? "current" : "" }, [
    element("th", { scope: "row" }, named(cube)),
    ...parts.map((text) => element("td", { text, className: "number" })),
    ...(errors ? [element("td", { text: error, className: "number" })] : []),
  ]));
  byId("readout").replaceChildren(element("thead", {}, [header]), element("tbody", {}, body));
}

/** A label after its colour; no line breaks between them. */
function named(cube, label = cube.entry.label) {
  const [first, ...others] = label.split(" ");
  const start = element("span", { className: "whole" }, [swatch(cube), document.createTextNode(first)]);
  return [start, document.createTextNode(others.map((word) => ` ${word}`).join(""))];
}

/** The colour of a method's curves. */
function swatch(cube) {
  const colour = cube.entry.reference ? "of-reference" : `method-${cube.index % 9}`;
  return element("span", { className: `swatch ${colour}`, "aria-hidden": "true" });
}
