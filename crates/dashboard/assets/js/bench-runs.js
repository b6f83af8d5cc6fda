// Runs of all benchmarks: instructions and rates of each case over commits, and what is not needed.

/** Three digits with a prefix. */
function shortCount(value) {
  if (value === null || value === undefined) return "–";
  const [scale, prefix] = [[1e9, " G"], [1e6, " M"], [1e3, " k"]].find(([s]) => Math.abs(value) >= s) ?? [1, ""];
  return `${digits(value / scale, 3)}${prefix}`;
}

/** A ratio of new over old; `better` is the direction of what is better: -1 less, 1 more. */
function ratioCell(ratio, better, slack, places) {
  if (ratio === null || ratio === undefined) return cell("", "number");
  const tone = Math.abs(ratio - 1) <= slack ? "" : Math.sign(ratio - 1) === better ? " good" : " bad";
  return cell(`×${ratio.toFixed(places)}`, `number${tone}`);
}

/** Instructions that differ by less are the same; times of a shared machine differ by much more. */
const SAME_INSTRUCTIONS = 0.001;
const SAME_TIME = 0.1;

function benchRunRow(row) {
  const rate = row.rate === null ? "–" : `${shortCount(row.rate)} ${row.unit}`;
  return element("tr", { "data-case-row": row.case }, [
    element("th", { scope: "row", text: row.case, title: row.command }), cell(shortCommit(row.commit)), cell(when(row.time)),
    cell(shortCount(row.instructions), "number"), ratioCell(row.instructions_change, -1, SAME_INSTRUCTIONS, 4), cell(row.counted_vectors ?? ""),
    cell(rate, "number"), ratioCell(row.rate_change, 1, SAME_TIME, 2),
    cell(digits(row.cpu_seconds, 3), "number"), ratioCell(row.cpu_change, -1, SAME_TIME, 2), cell(row.vectors), cell(row.machine),
  ]);
}

/** A card with the instructions of a case, or its CPU time where they were never counted. */
function benchRunCard(name, rows) {
  const last = rows.at(-1);
  const counted = rows.some((row) => row.instructions !== null);
  const parts = [
    ...(counted ? [`${shortCount(last.instructions)} instructions`] : [`${digits(last.cpu_seconds, 3)} CPU s`]),
    ...(last.rate === null ? [] : [`${shortCount(last.rate)} ${last.unit} per CPU s`]),
  ];
  const card = element("article", { className: "card bench", "data-case": name }, [
    element("h3", { text: name }),
    element("p", { className: "latest", text: parts.join(" · ") }),
    element("div", { className: "plot", role: "img" }),
  ]);
  const value = (row) => (counted ? row.instructions : row.cpu_seconds);
  const draw = () => {
    const keys = [...new Set(rows.map((row) => row.commit))];
    const machines = [...new Set(rows.map((row) => row.machine))];
    const at = (machine, commit) => rows.findLast((row) => row.machine === machine && row.commit === commit);
    const box = card.querySelector(".plot");
    trend(box, {
      labels: keys.map((commit) => shortCommit(commit).replace("-dirty", "+")),
      format: shortCount,
      series: machines.map((machine, index) => {
        const values = keys.map((commit) => { const row = at(machine, commit); return row ? value(row) : null; });
        const none = values.map(() => null);
        return { label: machine, colour: `--method-${index % 9}`, values, lows: none, highs: none };
      }),
      tip: (index) => machines.map((machine) => at(machine, keys[index])).filter(Boolean).map((row) => {
        const rate = row.rate === null ? "" : `, ${shortCount(row.rate)} ${row.unit} per CPU s`;
        return `${counted ? `${shortCount(row.instructions)} instructions` : `${digits(row.cpu_seconds, 3)} CPU s`}${rate}\ncommit ${row.commit}, ${when(row.time)}\n${row.machine}`;
      }).join("\n"),
    });
    box.setAttribute("aria-label", `${counted ? "Instructions" : "CPU time"} of ${name} over ${keys.length} commits; latest: ${parts.join(", ")}`);
  };
  return { card, draw };
}

/** What goals say of a ratio. */
const goalText = (cost) => (cost.at_most !== undefined ? `≤ ${cost.at_most}` : cost.at_least !== undefined ? `≥ ${cost.at_least}` : "");

function drawCosts(costs) {
  byId("costs-section").hidden = !costs;
  if (!costs) return;
  const [time, commit, rows] = costs;
  byId("costs").replaceChildren(
    tableHead([["case"], ["instructions of a pass"], ["over"], ["ratio", true], ["goal", true], [""]]),
    element("tbody", {}, rows.map((cost) => element("tr", {}, [
      element("th", { scope: "row", text: cost.name }),
      ...[0, 1].map((side) => cell(`${cost.sides[side]}: ${shortCount(cost.instructions[side])}`)),
      cell(cost.ratio.toFixed(4), "number"), cell(goalText(cost), "number"),
      cell(cost.met === null ? "" : cost.met ? "met" : "missed", cost.met === null ? "" : cost.met ? "good" : "bad"),
    ]))),
  );
  byId("costs-note").textContent = `Ratios of instructions of two renders that differ in one thing; ${when(time)}, commit ${shortCommit(commit)}.`;
}

/** Draws runs and costs; how many cases there are, and how many are shown. */
function drawBenchRuns(data) {
  const { rows, costs } = data.bench_runs;
  drawCosts(costs);
  const names = [...new Set(rows.map((row) => row.case))];
  const shown = names.filter((name) => matchesSearch(state.findBench, name, ""));
  byId("bench-runs-section").hidden = names.length === 0;
  const cards = shown.map((name) => benchRunCard(name, rows.filter((row) => row.case === name)));
  byId("bench-run-cards").replaceChildren(...cards.map(({ card }) => card));
  byId("bench-runs").replaceChildren(
    tableHead([["case"], ["commit"], ["ended"], ["instructions", true], ["old", true, "new over old"], ["with"], ["rate per CPU s", true], ["old", true, "new over old"], ["CPU s", true], ["old", true, "new over old"], ["with"], ["machine"]]),
    element("tbody", {}, shown.flatMap((name) => rows.filter((row) => row.case === name).slice(-8).reverse().map(benchRunRow))),
  );
  cards.forEach(({ draw }) => draw());
  return { all: names.length, shown: shown.length };
}
