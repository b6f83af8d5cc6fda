// Benchmarks over commits: a card for each, a curve for each machine.

/** Lines by benchmark: [{name, lines}]. */
function benchmarksOf(data) {
  const groups = new Map();
  for (const line of data.benchmarks) groups.set(line.bench, [...(groups.get(line.bench) ?? []), line]);
  return [...groups].map(([name, lines]) => ({ name, lines })).sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** How times of a benchmark are shown: per element or byte where that is known. */
function benchUnit(lines) {
  const last = lines.at(-1);
  const per = last.elements ? "elements" : last.bytes ? "bytes" : null;
  const of = (line) => (per && line[per] ? line[per] : 1);
  const largest = Math.max(...lines.map((line) => line.nanoseconds / of(line)));
  const [unit, size] = [["s", 1e9], ["ms", 1e6], ["µs", 1e3], ["ns", 1]].find(([, s]) => largest >= s) ?? ["ns", 1];
  const name = per === "elements" ? `${unit} per element` : per === "bytes" ? `${unit} per byte` : unit;
  const rate = per ? (line) => `${digits((1e3 * line[per]) / line.nanoseconds)} M ${per}/s` : () => "";
  return { name, of: (line, nanoseconds) => nanoseconds / of(line) / size, rate };
}

/** Change against the measurement before, with its interval: ratios in quadrature of logarithms. */
function benchChange(line, before) {
  const ratio = line.nanoseconds / before.nanoseconds;
  const log = (a, b) => Math.log(a / b);
  const down = Math.hypot(log(line.nanoseconds, line.interval[0]), log(before.interval[1], before.nanoseconds));
  const up = Math.hypot(log(line.interval[1], line.nanoseconds), log(before.nanoseconds, before.interval[0]));
  return { ratio, interval: [ratio * Math.exp(-down), ratio * Math.exp(up)] };
}

/** The latest value in words, with the change of that machine. */
function benchText({ lines }) {
  const unit = benchUnit(lines);
  const line = lines.at(-1);
  const value = (ns) => digits(unit.of(line, ns));
  const rate = unit.rate(line);
  const parts = [`${value(line.nanoseconds)} ${unit.name} [${value(line.interval[0])}, ${value(line.interval[1])}]`, ...(rate ? [rate] : [])];
  const before = lines.filter((other) => other.machine === line.machine).at(-2);
  let tone = "none";
  if (before) {
    const { ratio, interval } = benchChange(line, before);
    const change = (r) => signedPercent(r - 1);
    parts.push(`${change(ratio)} [${interval.map(change).join(", ")}] against ${shortCommit(before.commit)}`);
    tone = interval[0] > 1 ? "bad" : interval[1] < 1 ? "good" : "none";
  }
  return { parts, tone };
}

function benchCard(bench) {
  const { parts, tone } = benchText(bench);
  const line = bench.lines.at(-1);
  const guessed = line.commit_by === "time" ? " (told from the time)" : "";
  const pieces = [element("span", { text: parts.slice(0, parts.length > 2 ? -1 : undefined).join(" · ") })];
  if (parts.length > 2) pieces.push(element("br"), element("span", { className: tone, text: parts.at(-1) }));
  return element("article", { className: "card bench", "data-bench": bench.name }, [
    element("h3", { text: bench.name }),
    element("p", { className: "latest" }, pieces),
    element("div", { className: "plot", role: "img" }),
    element("p", { className: "note", text: `${when(line.time)}, commit ${shortCommit(line.commit)}${guessed}, ${line.statistic} with its ${digits(100 * line.confidence, 2)} % interval` }),
    element("p", { className: "note", text: [...new Set(bench.lines.map((l) => l.machine))].join(" · ") }),
  ]);
}

function drawBench(card, { name, lines }) {
  const unit = benchUnit(lines);
  const keys = [...new Set(lines.map((line) => line.commit))];
  const machines = [...new Set(lines.map((line) => line.machine))];
  const at = (machine, commit) => lines.findLast((line) => line.machine === machine && line.commit === commit);
  const column = (machine, of) => keys.map((commit) => {
    const line = at(machine, commit);
    return line ? unit.of(line, of(line)) : null;
  });
  const box = card.querySelector(".plot");
  trend(box, {
    labels: keys.map((commit) => shortCommit(commit).replace("-dirty", "+")),
    format: (value) => digits(value, 3),
    series: machines.map((machine, index) => ({
      label: machine, colour: `--method-${index % 9}`,
      values: column(machine, (l) => l.nanoseconds), lows: column(machine, (l) => l.interval[0]), highs: column(machine, (l) => l.interval[1]),
    })),
    tip: (index) => machines.map((machine) => at(machine, keys[index])).filter(Boolean).map((line) => {
      const value = (ns) => digits(unit.of(line, ns));
      return `${value(line.nanoseconds)} ${unit.name} [${value(line.interval[0])}, ${value(line.interval[1])}]\ncommit ${line.commit}, ${when(line.time)}\n${line.machine}`;
    }).join("\n"),
  });
  const { parts } = benchText({ lines });
  box.setAttribute("aria-label", `Time of ${name} over ${keys.length} commits; latest: ${parts.join(", ")}`);
}

function drawBenchmarks(data) {
  if (state.tab !== "benchmarks") return;
  const all = benchmarksOf(data);
  const runs = drawBenchRuns(data);
  const count = all.length + runs.all;
  byId("benchmarks-filter").hidden = count === 0;
  byId("criterion-section").hidden = all.length === 0;
  byId("benchmarks-missing").replaceChildren(...(count ? [] : [missingCard("No benchmark was measured yet.", COMMANDS.bench)]));
  const shown = all.filter((bench) => matchesSearch(state.findBench, bench.name, ""));
  const cards = shown.map(benchCard);
  byId("benchmark-cards").replaceChildren(...cards);
  byId("found-bench").textContent = `${shown.length + runs.shown} of ${count} benchmarks`;
  cards.forEach((card, index) => drawBench(card, shown[index]));
}
