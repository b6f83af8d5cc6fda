// What is behind a row: remarks, pictures, controls, history, and the command that repeats it.

/** A list of remarks. */
const remarkList = (notes) => element("ul", {}, notes.map((text) => element("li", { text })));

/** Everything that is known of a row, as the content of one wide cell. */
function detailsOf(data, row) {
  const [run, record] = row.latest ? [data.overview.runs[row.latest[0]], row.latest[1]] : [null, null];
  const left = element("div", {}, [
    ...(row.description ? [element("p", { text: row.description })] : []),
    ...(record?.error ? [element("p", { className: "bad", text: record.error })] : []),
    ...(record?.notes?.length ? [remarkList(record.notes)] : []),
    ...(run ? [element("dl", {}, terms(factsOf(run, record)))] : [element("p", { className: "note", text: "There is no result yet." })]),
    element("h3", { text: record ? "Repeat it" : "Run it" }),
    commandBox(record?.repeat ?? row.command),
  ]);
  const right = element("div", {}, historyOf(data, row));
  return [
    element("div", { className: "details-grid" }, [left, right]),
    ...controlsOf(row),
    ...tableOf(record),
    ...picturesOf(data, row),
  ];
}

/** A table that is text. */
function tableOf(record) {
  if (!record?.table?.length) return [];
  const lines = element("pre", { tabindex: "0", className: "text-table", text: record.table.join("\n") });
  return [element("h3", { text: "Table" }), lines];
}

function factsOf(run, record) {
  const tests = record.batches ? `${record.contrasts} contrasts, ${record.batches} batches` : "";
  return [
    ["verdict", VERDICTS[record.verdict].word],
    ["relative error", record.interval ? intervalText(record.interval) : ""],
    ["p", record.p === null || record.p === undefined ? "" : pText(record.p)],
    ["tests", tests],
    ["took", duration(record.seconds)],
    ["commit", run.commit],
    ["run", `${when(run.time)}, ${run.flags}`],
    ["machine", run.machine],
    ["seed", run.seed],
    ["left", (record.files ?? []).join(", ")],
  ];
}

/** A table of the negative controls. */
function controlsOf(row) {
  if (!row.controls?.length) return [];
  const body = row.controls.map((control) => {
    const record = control.latest?.[1];
    const verdict = record?.verdict ?? "missing";
    const word = { passed: "rejected", failed: "not rejected" }[verdict];
    return element("tr", {}, [
      element("th", { scope: "row", text: control.defect }),
      element("td", {}, [verdictBadge(verdict, word)]),
      cell(record?.interval ? intervalText(record.interval) : "–", "number"),
      cell(pText(record?.p), "number"),
      cell(duration(record?.seconds), "number"),
    ]);
  });
  const failed = row.controls.filter((c) => c.latest && c.latest[1].verdict !== "passed");
  return [
    element("h3", { text: "Negative controls" }),
    element("p", { className: "note", text: "The same experiment with a defect made on purpose, at the same budget: it must be rejected." }),
    element("div", { className: "scroll" }, [element("table", {}, [
      tableHead([["defect"], ["verdict"], ["relative error", true], ["p", true], ["took", true]]),
      element("tbody", {}, body),
    ])]),
    ...failed.flatMap((control) => [remarkList(control.latest[1].notes ?? []), commandBox(control.latest[1].repeat ?? control.command)]),
  ];
}

/** Pictures that it left because it did not pass. */
function picturesOf(data, row) {
  const rows = [row, ...(row.controls ?? [])];
  const all = rows.flatMap((r) => (data.pictures[r.name] ?? []).map(([name, address]) => ({ name, address, row: r })));
  if (all.length === 0) return [];
  const figure = ({ name, address, row: of }) => element("figure", {}, [
    element("img", { src: address, alt: `${name} of ${of.name}`, loading: "lazy" }), element("figcaption", { text: name }),
  ]);
  return [element("h3", { text: "What it left" }), element("div", { className: "pictures" }, all.map(figure))];
}

/** Charts of the interval and of the seconds over runs; drawn once they are on the page. */
function historyOf(data, row) {
  if (row.history.length === 0) return [];
  const measured = row.history.some((point) => point.interval);
  const chart = (what) => element("div", { className: "plot", role: "img", "data-history": what });
  return [
    ...(measured ? [element("h3", { text: "Relative error over runs" }), chart("interval")] : []),
    element("h3", { text: "Seconds over runs" }), chart("seconds"),
  ];
}

/** Draws the charts of an open row. */
function drawHistory(data, row, cellNode) {
  const runs = row.history.map((point) => data.overview.runs[point.run]);
  const labels = runs.map((run) => shortCommit(run.commit).replace("-dirty", "+"));
  const told = (point, index) => [
    `${VERDICTS[point.verdict].word}, ${when(runs[index].time)}`,
    `commit ${runs[index].commit}, ${runs[index].effort}, seed ${runs[index].seed}`,
  ];
  const none = row.history.map(() => null);
  for (const box of cellNode.querySelectorAll("[data-history]")) {
    const of = box.dataset.history;
    const ends = (side) => row.history.map((point) => (point.interval ? point.interval[side] : null));
    const middle = row.history.map((point) => (point.interval && !point.interval.includes(null) ? 0.5 * (point.interval[0] + point.interval[1]) : null));
    const seconds = row.history.map((point) => point.seconds);
    const text = (point) => (of === "interval" ? `relative error ${intervalText(point.interval)}, p ${pText(point.p)}` : duration(point.seconds));
    const spec = of === "interval"
      ? { zero: true, format: (v) => (v === 0 ? "0" : `${digits(100 * v, 2)} %`), series: [{ label: "relative error", colour: "--method-0", values: middle, lows: ends(0), highs: ends(1) }] }
      : { zero: true, format: (v) => `${digits(v, 2)} s`, series: [{ label: "seconds", colour: "--method-2", values: seconds, lows: none, highs: none }] };
    trend(box, { ...spec, labels, tip: (index) => [text(row.history[index]), ...told(row.history[index], index)].join("\n") });
    const last = row.history.length - 1;
    box.setAttribute("aria-label", `${of === "interval" ? "Relative error" : "Seconds"} of ${row.name} over ${row.history.length} runs; latest: ${text(row.history[last])}`);
  }
}
