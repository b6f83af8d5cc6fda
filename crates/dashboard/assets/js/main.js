// Reads the data, builds the tabs, and ties drawing to the state.

const TABS = [
  { name: "overview", label: "Overview" },
  { name: "errors", label: "Error against time" },
  { name: "benchmarks", label: "Benchmarks" },
  { name: "pages", label: "Comparisons" },
];

Object.assign(state, {
  tab: "overview",
  find: "",
  findBench: "",
  verdict: "all",
  sort: "suite",
  open: "", // name of the experiment whose details are shown
  scene: "",
  metric: "nmse",
  clock: "cpu",
  base: "", // factors are over this method; the path tracer if there is one
  hidden: "", // methods that are not shown, with spaces between
  atTime: null, // seconds; null: the longest that all methods have
  atError: null, // null: what the base reaches
  point: null, // of the chart, by keys: {curve, at}
  theme: "",
  size: 0,
});

function showTab(name) {
  update({ tab: name });
  history.replaceState(null, "", `#tab=${name}`);
}

function buildTabs(data) {
  const failed = data.overview.rows.filter((row) => ["failed", "broken"].includes(stateOf(row))).length;
  byId("tabs").replaceChildren(...TABS.map(({ name, label }, index) => {
    const badge = name === "overview" && failed ? [element("span", { className: "badge", text: String(failed), title: "did not pass" })] : [];
    const button = element("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": name, "aria-keyshortcuts": String(index + 1) }, [document.createTextNode(label), ...badge]);
    button.addEventListener("click", () => showTab(name));
    return button;
  }));
}

function syncTabs() {
  for (const { name } of TABS) {
    const chosen = name === state.tab;
    byId(name).hidden = !chosen;
    byId(`tab-${name}`).setAttribute("aria-selected", String(chosen));
    byId(`tab-${name}`).tabIndex = chosen ? 0 : -1;
  }
}

function buildOverview(data) {
  const some = data.overview.rows.some((row) => row.suite === "");
  const verdicts = ["all", ...Object.keys(VERDICTS).filter((name) => name !== "retired" || some)];
  byId("verdict").replaceChildren(...verdicts.map((value) => element("option", { value, text: value === "all" ? "all" : VERDICTS[value].word })));
  byId("verdict").addEventListener("change", (event) => update({ verdict: event.target.value }));
  byId("find").addEventListener("input", (event) => update({ find: event.target.value }));
  byId("find-bench").addEventListener("input", (event) => update({ findBench: event.target.value }));
  byId("remarks").replaceChildren(...data.remarks.map((text) => element("p", { className: "card note remark", text })));
  byId("remarks").hidden = data.remarks.length === 0;
  drawLatestRun(data);
  drawMap(data);
}

function drawOverview(data) {
  byId("verdict").value = state.verdict;
  drawCounts(data);
  drawExperiments(data);
}

/** Reads a link such as `#tab=errors&scene=cornell-blocks&clock=wall`. */
function readLink(data) {
  const link = new URLSearchParams(location.hash.slice(1));
  const changes = {};
  const take = (key, known) => known.includes(link.get(key)) && (changes[key] = link.get(key));
  take("tab", TABS.map((tab) => tab.name));
  take("verdict", ["all", ...Object.keys(VERDICTS)]);
  take("scene", data.error_time.scenes.map((scene) => scene.scene));
  take("metric", Object.keys(ERROR_METRICS));
  take("clock", Object.keys(CLOCKS));
  take("base", data.error_time.scenes.flatMap((scene) => scene.curves.map((curve) => curve.method)));
  take("open", data.overview.rows.map((row) => row.name));
  if (link.has("find")) byId("find").value = changes.find = link.get("find");
  if (["dark", "light"].includes(link.get("theme"))) document.documentElement.dataset.theme = changes.theme = link.get("theme");
  update(changes);
}

function tie(data) {
  onChange(["tab"], syncTabs);
  onChange(["find", "verdict", "sort", "open"], () => drawOverview(data));
  onChange(["tab", "scene", "metric", "clock", "base", "hidden", "atTime", "atError"], () => drawErrors(data));
  onChange(["tab", "findBench"], () => drawBenchmarks(data));
  onChange(["tab", "theme", "size"], redrawPlots);
}

function start() {
  const data = JSON.parse(byId("data").textContent);
  byId("caption").textContent = `Dashboard of ${when(data.time)} · commit ${shortCommit(data.commit)} · ${data.machine}`;
  byId("footer").textContent = `Page by ${data.program}, with uPlot 1.6.32 (MIT). It asks the network for nothing. To renew it: cargo xtask dashboard.`;
  buildTabs(data);
  buildOverview(data);
  buildErrors(data);
  drawShelves(data);
  byId("theme").addEventListener("click", toggleTheme);
  byId("help-open").addEventListener("click", toggleHelp);
  byId("help-close").addEventListener("click", toggleHelp);
  listKeys([...KEYS.map((key) => key[1]), "← → ↑ ↓: from point to point, on the chart of errors"]);
  byId("main").hidden = false;
  byId("loading").hidden = true;
  tie(data);
  readLink(data);
  syncTabs();
  drawOverview(data);
  drawErrors(data);
  drawBenchmarks(data);
  listenToKeys(data);
  let width = innerWidth;
  addEventListener("resize", () => innerWidth !== width && update({ size: (width = innerWidth) }));
  addEventListener("hashchange", () => readLink(data));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => update({ theme: `system ${event.matches}` }));
  /** For scripts and tests: the state, and what is shown. */
  window.tpbDashboard = { state, update, settled, data, plots, factorAtTime, factorAtError, curvePoints, stateOf };
}

try {
  start();
} catch (error) {
  byId("loading").hidden = false;
  byId("loading").textContent = `This page cannot be shown: ${error.message}. It needs a browser of 2023 or later.`;
  console.error(error);
}
