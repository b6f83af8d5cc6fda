// The table of experiments, the counts above it, and the runs below.

function drawCounts(data) {
  const rows = data.overview.rows;
  const kinds = ["passed", "failed", "broken", "missing", "retired"];
  const counts = Object.fromEntries(kinds.map((kind) => [kind, rows.filter((row) => stateOf(row) === kind).length]));
  byId("counts").replaceChildren(...kinds.filter((kind) => counts[kind] > 0 || kind === "passed" || kind === "failed").map((kind) => {
    const { word, tone } = VERDICTS[kind];
    const button = element("button", { type: "button", "aria-pressed": String(state.verdict === kind) }, [
      element("strong", { className: counts[kind] ? tone : "none", text: String(counts[kind]) }), element("span", { text: word }),
    ]);
    button.addEventListener("click", () => update({ verdict: state.verdict === kind ? "all" : kind }));
    return button;
  }));
  const controls = rows.flatMap((row) => row.controls ?? []).filter((control) => control.latest);
  const rejected = controls.filter((control) => control.latest[1].verdict === "passed").length;
  const note = "Of each experiment its latest result counts, also of runs of some experiments only.";
  byId("counts-note").textContent = controls.length ? `${rejected} of ${controls.length} negative controls were rejected, as they must be. ${note}` : note;
}

/** All experiments at a glance, with a gap between groups: for the mouse, the table is for all. */
function drawMap(data) {
  const nodes = [];
  let group = null;
  for (const row of data.overview.rows.filter((r) => r.suite !== "")) {
    if (group !== null && groupOf(row) !== group) nodes.push(element("span", { className: "gap" }));
    group = groupOf(row);
    const verdict = stateOf(row);
    const square = element("span", { className: VERDICTS[verdict].tone, title: `${row.name}: ${VERDICTS[verdict].word}` });
    square.addEventListener("click", () => {
      byId("find").value = "";
      update({ open: row.name, find: "", verdict: "all" });
      settled().then(() => experimentButton(row.name)?.scrollIntoView({ block: "center" }));
    });
    nodes.push(square);
  }
  byId("map").replaceChildren(...nodes);
}

function drawLatestRun(data) {
  const run = data.overview.runs.at(-1);
  byId("runs-section").hidden = !run;
  if (!run) {
    byId("latest-run").replaceWith(missingCard("The suite was not run yet, or its history is gone.", COMMANDS.validate));
    return;
  }
  byId("latest-run").replaceChildren(...terms([
    ["ended", `${when(run.time)}, after ${duration(run.seconds)}`],
    ["commit", run.commit],
    ["machine", run.machine],
    ["flags", run.flags],
    ["seed", run.seed],
    ["verdicts", `${run.counts[0]} passed, ${run.counts[1]} failed, ${run.counts[2]} broken`],
    ["false alarm", run.false_alarm === null ? "" : `${digits(run.false_alarm, 2)} (nominal ${digits(run.nominal, 1)} for a whole suite)`],
    ["noise hides a claim", run.unresolved === null ? "" : digits(run.unresolved, 2)],
  ]));
  const row = (r) => element("tr", {}, [
    element("th", { scope: "row", text: when(r.time) }), cell(shortCommit(r.commit)), cell(r.effort),
    cell(String(r.counts[0]), "number"),
    cell(String(r.counts[1]), r.counts[1] ? "number bad" : "number"), cell(String(r.counts[2]), r.counts[2] ? "number odd" : "number"),
    cell(duration(r.seconds), "number"), cell(r.false_alarm === null ? "–" : digits(r.false_alarm, 2), "number"),
    element("td", { className: "flags", text: r.flags, title: r.flags }), cell(String(r.seed), "number"), cell(r.machine),
  ]);
  byId("runs").replaceChildren(
    tableHead([["ended"], ["commit"], ["suite"], ["passed", true], ["failed", true], ["broken", true], ["took", true], ["false alarm", true, "chance that a sound program is called wrong"], ["flags"], ["seed", true], ["machine"]]),
    element("tbody", {}, [...data.overview.runs].reverse().map(row)),
  );
}

const EXPERIMENT_COLUMNS = [
  ["verdict", "verdict"], ["experiment", null], ["relative error", "error"], ["p", "p", true], ["took", "seconds", true],
  ["negative controls", null], ["history", null], ["commit", null],
];

function experimentHead() {
  return element("thead", {}, [element("tr", {}, EXPERIMENT_COLUMNS.map(([text, sort, number]) => {
    const sorted = sort !== null && state.sort === sort;
    const column = element("th", { scope: "col", ...(number ? { className: "number" } : {}), ...(sorted ? { "aria-sort": "descending" } : {}) });
    if (sort === null) column.append(text);
    else {
      const button = element("button", { type: "button", text: sorted ? `${text} ▾` : text, title: sorted ? "back to the suite's order" : "worst first" });
      button.addEventListener("click", () => update({ sort: sorted ? "suite" : sort }));
      column.append(button);
    }
    return column;
  }))]);
}

/** The row of an experiment, and that of its details if it is open. */
function experimentRows(data, row) {
  const verdict = stateOf(row);
  const record = row.latest?.[1];
  const run = row.latest ? data.overview.runs[row.latest[0]] : null;
  const open = state.open === row.name;
  const name = element("button", { type: "button", text: row.name, "aria-expanded": String(open), "data-experiment": row.name });
  name.addEventListener("click", () => update({ open: state.open === row.name ? "" : row.name }));
  const error = record?.interval
    ? [intervalBar(record.interval, verdict), document.createTextNode(intervalText(record.interval))]
    : record?.error ? [element("span", { className: "bad", text: "no result" })] : [];
  const word = verdict === "failed" && record.verdict === "passed" ? "control failed" : undefined;
  const main = element("tr", { "data-row": row.name }, [
    element("td", {}, [verdictBadge(verdict, word)]),
    element("th", { scope: "row", className: "name" }, [name]),
    element("td", { className: "error" }, error),
    cell(record ? pText(record.p) : "", "number"),
    cell(record ? duration(record.seconds) : row.suite === "full" ? "full suite" : "", "number"),
    element("td", { className: "controls" }, controlTexts(row)),
    element("td", { className: "history" }, [historyStrip(data, row)]),
    element("td", { className: "run", text: run ? shortCommit(run.commit) : "", title: run ? `${when(run.time)}, ${run.flags}` : "" }),
  ]);
  if (!open) return [main];
  const wide = element("td", { colspan: String(EXPERIMENT_COLUMNS.length) }, detailsOf(data, row));
  return [main, element("tr", { className: "details" }, [wide])];
}

/** Rows with a heading for each group, as long as they are in the suite's order. */
function bodyRows(data, rows) {
  const nodes = [];
  let group = null;
  for (const row of rows) {
    if (state.sort === "suite" && groupOf(row) !== group) {
      group = groupOf(row);
      const members = rows.filter((r) => groupOf(r) === group);
      const passed = members.filter((r) => stateOf(r) === "passed").length;
      nodes.push(element("tr", { className: "group" }, [element("th", { scope: "rowgroup", colspan: String(EXPERIMENT_COLUMNS.length) }, [
        document.createTextNode(group), element("span", { className: "note", text: `${passed} of ${members.length} passed` }),
      ])]));
    }
    nodes.push(...experimentRows(data, row));
  }
  return nodes;
}

function drawExperiments(data) {
  const rows = chosenRows(data);
  const focused = document.activeElement?.dataset?.experiment;
  byId("experiments").replaceChildren(experimentHead(), element("tbody", {}, bodyRows(data, rows)));
  byId("found").textContent = `${rows.length} of ${data.overview.rows.filter((row) => row.suite !== "").length} experiments`;
  if (focused) experimentButton(focused)?.focus();
  const open = rows.find((row) => row.name === state.open);
  if (open) drawHistory(data, open, byId("experiments").querySelector(".details"));
}

const experimentButton = (name) => byId("experiments").querySelector(`[data-experiment="${CSS.escape(name)}"]`);

/** Moves the focus to the next (+1) or last (−1) experiment that is shown. */
function stepExperiment(step) {
  const buttons = [...byId("experiments").querySelectorAll("[data-experiment]")];
  const at = buttons.indexOf(document.activeElement);
  const next = at < 0 ? (step > 0 ? 0 : buttons.length - 1) : Math.min(buttons.length - 1, Math.max(0, at + step));
  buttons[next]?.focus();
  buttons[next]?.scrollIntoView({ block: "nearest" });
}
