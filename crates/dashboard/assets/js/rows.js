// What the table of experiments shows of each, and in which order.

/** The verdict of a row: its own, unless a negative control was not rejected. */
function stateOf(row) {
  if (row.suite === "") return "retired";
  if (!row.latest) return "missing";
  const own = row.latest[1].verdict;
  return own === "passed" && badControls(row).length > 0 ? "failed" : own;
}

const badControls = (row) => (row.controls ?? []).filter((c) => c.suite !== "" && c.latest && c.latest[1].verdict !== "passed");

/** What a search looks through beside the name. */
function wordsOf(row) {
  const own = row.latest ? [...(row.latest[1].notes ?? []), row.latest[1].error ?? ""] : [];
  return [row.description, ...own, ...(row.controls ?? []).map((c) => c.name)].join(" ");
}

const farthest = (row) => {
  const interval = row.latest?.[1].interval;
  return interval ? Math.max(...interval.map((end) => (end === null ? Infinity : Math.abs(end)))) : -1;
};

/** Columns by which one may sort: what comes first is what is worst. */
const SORTS = {
  verdict: (row) => ["failed", "broken", "missing", "passed", "retired"].indexOf(stateOf(row)),
  error: (row) => -farthest(row),
  p: (row) => row.latest?.[1].p ?? 2,
  seconds: (row) => -(row.latest?.[1].seconds ?? -1),
};

/** The rows that are asked for, in the order that is asked for. */
function chosenRows(data) {
  const wanted = (row) => {
    const verdict = stateOf(row);
    if (state.verdict === "all" ? verdict === "retired" : verdict !== state.verdict) return false;
    return matchesSearch(state.find, row.name, wordsOf(row));
  };
  const rows = data.overview.rows.filter(wanted);
  const groups = [...new Set(rows.map(groupOf))];
  const key = SORTS[state.sort] ?? ((row) => groups.indexOf(groupOf(row)));
  return rows.map((row) => [key(row), row]).sort((a, b) => a[0] - b[0]).map(([, row]) => row);
}

const groupOf = (row) => row.name.split("/")[0];

const SVG = "http://www.w3.org/2000/svg";

function svgElement(tag, attributes, children = []) {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

/** Relative errors beyond this are at the edge of a bar. */
const BAR_END = 0.02;

/** An interval of relative errors as a bar around 0; its text stands beside it. */
function intervalBar(interval, verdict) {
  const [width, height] = [88, 14];
  const at = (value) => 0.5 * width * (1 + Math.max(-1, Math.min(1, (value ?? Infinity) / BAR_END)));
  const [left, right] = [interval[0] === null ? 0 : at(interval[0]), at(interval[1])];
  const colour = `var(--${VERDICTS[verdict].tone === "none" ? "muted" : VERDICTS[verdict].tone})`;
  const x = Math.min(left, width - 3);
  return element("span", { className: "bar", title: "from −2 % to +2 %, beyond at the edge" }, [
    svgElement("svg", { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" }, [
      svgElement("rect", { x: 0, y: 6.5, width, height: 1, fill: "var(--line)" }),
      svgElement("rect", { x: 0.5 * width - 0.5, y: 1, width: 1, height: 12, fill: "var(--muted)" }),
      svgElement("rect", { x, y: 4, width: Math.max(3, right - x), height: 6, rx: 2, fill: colour }),
    ]),
  ]);
}

/** The latest verdicts as small squares, and in words for those who do not see them. */
function historyStrip(data, row) {
  const points = row.history.slice(-16);
  if (points.length === 0) return element("span", {});
  const size = 8;
  const squares = points.map((point, index) => {
    const { tone, word } = VERDICTS[point.verdict];
    const run = data.overview.runs[point.run];
    const high = point.verdict === "passed" ? 7 : 12;
    return svgElement("rect", {
      x: index * size, y: 13 - high, width: size - 2, height: high, rx: 1, fill: `var(--${tone})`,
    }, [svgElement("title", {}, [`${word}, ${shortCommit(run.commit)}, ${when(run.time)}`])]);
  });
  const passed = points.filter((point) => point.verdict === "passed").length;
  const width = points.length * size;
  return svgElement("svg", {
    width, height: 14, viewBox: `0 0 ${width} 14`, role: "img",
    "aria-label": `passed ${passed} of the last ${points.length} runs`,
  }, squares);
}

/** The negative controls of a row in a few words. */
function controlTexts(row) {
  return (row.controls ?? []).flatMap((control, index) => {
    const verdict = control.latest ? control.latest[1].verdict : "missing";
    const word = { passed: "rejected", failed: "NOT REJECTED", broken: "broken", missing: "not run" }[verdict];
    const parts = index > 0 ? [document.createTextNode(", ")] : [];
    return [...parts, element("span", { className: VERDICTS[verdict].tone, text: `${control.defect}: ${word}` })];
  });
}
