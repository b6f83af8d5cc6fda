// Error numbers, how each result was made, and what the page holds of it.

const COLUMNS = [
  ["RMSE", "root mean squared error, in the unit of the cells", (m) => m.rmse, (m) => digits(m.rmse)],
  ["NMSE", "Σ(x − r)²/Σr²", (m) => m.nmse, (m) => digits(m.nmse)],
  ["noise", "part of NMSE that noise is expected to make: Σ(v + v_r)/Σr²", (m) => m.noise, (m) => digits(m.noise)],
  ["bias²", "NMSE − noise: an estimate of the squared bias", () => null, (m) => digits(m.squared_bias)],
  ["relMSE", "mean of (x − r)²/(r² + ε²)", (m) => m.relative_mse, (m) => digits(m.relative_mse)],
  ["MAPE", "mean of |x − r|/(|r| + ε)", (m) => m.mape, (m) => percent(m.mape)],
  ["SMAPE", "mean of 2|x − r|/(|x| + |r| + ε)", (m) => m.smape, (m) => percent(m.smape)],
  ["bias", "Σ(x − r)/Σr, with its 95 % interval (Student's t) if cells err independently (in brackets: at most)", () => null, biasText],
];

function biasText(m) {
  if (m.bias === null) return "–";
  const sign = m.bias > 0 ? "+" : "";
  const half = m.bias_half;
  const interval = half ? ` ± ${percent(half.independent, 2)} (${percent(half.bound, 2)})` : "";
  return `${sign}${percent(m.bias)}${interval}`;
}

/** Rows of one group: a heading, then the methods, the best of each column in bold. */
function numberRows(v, label, which) {
  const judged = v.cubes.filter((cube) => cube.entry.numbers?.[which]);
  if (judged.length === 0) return [];
  const metrics = judged.map((cube) => cube.entry.numbers[which]);
  const best = COLUMNS.map(([, , size]) => {
    const sizes = metrics.map(size).filter((s) => s !== null && s !== undefined);
    return judged.length > 1 && sizes.length ? Math.min(...sizes) : NaN;
  });
  const heading = element("tr", { className: "group" }, [
    element("th", { text: label, colspan: String(COLUMNS.length + 1), scope: "colgroup" }),
  ]);
  const rows = judged.map((cube, i) => element("tr", {}, [
    element("th", { scope: "row" }, named(cube)),
    ...COLUMNS.map(([, , size, text], column) => element("td", {
      className: size(metrics[i]) === best[column] ? "number best" : "number", text: text(metrics[i]),
    })),
  ]));
  return [heading, ...rows];
}

function drawNumbers(v) {
  const section = byId("numbers-section");
  section.hidden = !v.reference || v.cubes.length < 2;
  if (section.hidden) return;
  byId("numbers-title").textContent = `Error against ${v.reference.entry.label}`;
  const header = element("tr", {}, [
    element("th", { text: "method", scope: "col" }),
    ...COLUMNS.map(([name, title]) => element("th", { text: name, title, scope: "col", className: "number" })),
  ]);
  const label = v.manifest.judged_label;
  byId("numbers").replaceChildren(element("thead", {}, [header]), element("tbody", {}, [
    ...(label ? numberRows(v, `Cells of ${label}`, "judged_cube") : []),
    ...numberRows(v, "All cells", "cube"),
    ...(label ? numberRows(v, `Steady image, ${label}`, "judged_steady") : []),
    ...numberRows(v, "Steady image", "steady"),
  ]));
  const numbers = v.cubes.map((cube) => cube.entry.numbers).find(Boolean);
  const of = numbers.cube ?? numbers.steady;
  const notes = [
    `ε = 1 % of the mean of the reference's lit cells = ${digits(of.epsilon)}. Numbers are over all channels, at full size. The smallest of a column is bold.`,
  ];
  if (v.cubes.some((cube) => (cube.entry.numbers?.cube?.noise ?? null) !== null)) {
    notes.push("noise and bias² need no independence of cells; the interval of the bias takes cells as independent, in brackets its widest.");
  }
  for (const { entry } of v.cubes.filter(({ entry }) => !entry.independent)) {
    notes.push(`${entry.label} was rendered from the same random numbers as the reference: noise cannot be told from bias.`);
  }
  const out = v.cubes.filter((cube) => cube.entry.numbers?.cube?.left_out);
  for (const cube of out) notes.push(`${cube.entry.label}: ${cube.entry.numbers.cube.left_out} cells are not finite and are left out.`);
  byId("numbers-note").replaceChildren(...notes.map((text) => element("p", { text })));
}

/** Names of options do not break after their first hyphen. */
const unbroken = (text) => text.replaceAll("--", "-\u2060-");

/** What the maker of the page has to say. */
function drawNotes(v) {
  byId("notes-section").hidden = v.manifest.notes.length === 0;
  byId("notes").replaceChildren(...v.manifest.notes.map((text) => element("li", { text: unbroken(text) })));
}

/** A card for each result: what it is, how it was made, the command that repeats it. */
function drawProvenance(v) {
  const card = (cube) => {
    const { label, caption, provenance, command, reference } = cube.entry;
    const parts = [element("h3", {}, named(cube, reference ? `${label} (reference)` : label))];
    if (caption) parts.push(element("p", { text: caption }));
    if (provenance.length) {
      parts.push(element("dl", {}, provenance.flatMap(([name, value]) => [element("dt", { text: name }), element("dd", { text: value })])));
    }
    if (command) parts.push(commandBox(command));
    if (!provenance.length && !command) parts.push(element("p", { className: "note", text: "Nothing is known of how it was made." }));
    return element("article", { className: "card" }, parts);
  };
  byId("provenance").replaceChildren(...v.cubes.map(card));
}

function drawPacking(v) {
  const { shape, rendered, factors, program, code } = v.manifest;
  const size = (s) => `${s.width} × ${s.height} pixels${s.bins ? ` × ${s.bins} bins` : ""}`;
  const [pixels, bins] = factors;
  const parts = [pixels > 1 ? `means over ${pixels} × ${pixels} pixels` : "", bins > 1 ? `sums over ${bins} bins` : ""].filter(Boolean);
  const shown = parts.length
    ? `Shown: ${size(shape)} of ${size(rendered)} rendered, as exact ${parts.join(" and ")}, to keep the page small; error numbers and curves over all pixels are those of the full size${v.manifest.curve_bins > 1 ? `, these for groups of ${v.manifest.curve_bins} bins` : ""}.`
    : `Shown: all ${size(shape)} that were rendered.`;
  const counted = v.bins > 0 ? "Bins, columns and rows count from 0, as in the arrays." : "Columns and rows count from 0, as in the arrays.";
  const when = v.bins === 0 || !v.manifest.timed ? "" : v.energies
    ? " A frame is named by the middle of its bin of time."
    : " A frame is the radiance at the upper edge of its bin, and is named by that time.";
  const step = (steps) => digits(100 * (2 ** (0.5 / steps) - 1), 2);
  const stored = `Stored on a logarithmic scale: cells within ±${step(code.steps)} %, images within ±${step(code.image_steps)} %, standard errors within ±${step(code.error_steps)} %; zero is exact.`;
  byId("packing").replaceChildren(
    element("p", { text: `${shown} ${counted}${when}`, id: "shown" }),
    element("p", { text: stored }),
    element("p", { text: `Page by ${program}, with uPlot 1.6.32 (MIT). It asks the network for nothing.` }),
  );
}
