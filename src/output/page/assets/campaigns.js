// Campaigns: sweeps with their samples, stress tests, and other reports as they are.

const HISTOGRAM_BINS = 30;
const MAX_WORST = 12;

function campaignSection(campaign) {
  const title = [campaign.kind, campaign.folder.replace("/", " · ")].filter((part) => part).join(": ");
  const show = { sweep: sweepContent, stress: stressContent }[campaign.kind] || plainContent;
  return element("article", { class: "campaign", id: `${campaign.kind}/${campaign.folder}` }, element("h2", {}, title), show(campaign));
}

function sweepContent({ result, samples }) {
  const { statistics } = result;
  const [low, high] = interval(statistics);
  const rate = `${statistics.passed} of ${statistics.samples} samples passed (${(100 * statistics.passed / Math.max(1, statistics.samples)).toFixed(1)} %)`;
  const bounds = low === null ? "" : `; 95 % confidence interval ${(100 * low).toFixed(1)} to ${(100 * high).toFixed(1)} %`;
  const drawn = `Drawn per sample: ${Object.entries(result.spread).map(([name, value]) => `${name} ${value}`).join(", ")}.`;
  return [
    element("p", { class: "headline" }, rate + bounds),
    element("p", { class: "muted" }, drawn),
    samples ? sampleViews(samples) : element("p", { class: "muted" }, "The samples (sweep.parquet) are not there."),
  ];
}

/** The confidence interval, under whichever name the statistics have it. */
function interval(statistics) {
  const found = Object.values(statistics).find((value) => Array.isArray(value) && value.length === 2 && value.every((it) => it >= 0 && it <= 1));
  return found || [null, null];
}

function sampleViews(samples) {
  const varied = samples.drawn.filter(([, values]) => values.some((value) => value !== values[0]));
  const measured = samples.margins.filter(([, , values]) => values.some((value) => value !== null && value !== values[0]));
  if (measured.length === 0) return worstSamples(samples);
  const isWorse = (values) => Math.min(...values.filter((value) => value !== null));
  const byMargin = [...measured].sort((a, b) => isWorse(a[2]) - isWorse(b[2]));
  const check = element("select", { "aria-label": "check" }, byMargin.map(([name, unit]) => element("option", {}, `${name} [${unit}]`)));
  const cause = element("select", { "aria-label": "what was drawn" }, varied.map(([name]) => element("option", {}, name)));
  const charts = element("div", { class: "plots" });
  const update = () => {
    const [name, unit, margins] = byMargin[check.selectedIndex];
    const title = `margin of ${name} [${unit}]`;
    const parts = [histogram(title, margins)];
    if (varied.length > 0) parts.push(scatter(varied[Math.max(0, cause.selectedIndex)], title, margins, samples.verdict));
    charts.replaceChildren(...parts);
  };
  check.addEventListener("change", update);
  cause.addEventListener("change", update);
  update();
  return element("div", {}, element("div", { class: "toolbar" }, check, varied.length > 0 ? cause : null), charts, worstSamples(samples));
}

function histogram(title, margins) {
  const values = margins.filter((value) => value !== null);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const width = (high - low) / HISTOGRAM_BINS || 1;
  const counts = new Array(HISTOGRAM_BINS).fill(0);
  values.forEach((value) => counts[Math.min(HISTOGRAM_BINS - 1, Math.floor((value - low) / width))]++);
  const centres = counts.map((_, bin) => low + (bin + 0.5) * width);
  return chart(title, [centres, counts], "samples", {
    label: "samples", stroke: themed("accent"), fill: themed("accent"), paths: uPlot.paths.bars({ size: [0.9, 60] }), points: { show: false },
  }, { x: [Math.min(0, low - width), Math.max(0, high + width)] }, zeroLine);
}

function scatter([name, drawn], title, margins, verdicts) {
  const order = drawn.map((_, index) => index).filter((index) => margins[index] !== null).sort((a, b) => drawn[a] - drawn[b]);
  const at = (wanted) => order.map((index) => ((verdicts[index] === "PASS") === wanted ? margins[index] : null));
  const dots = (label, colour) => ({ label, paths: () => null, points: { show: true, size: 6, fill: themed(colour), stroke: themed(colour) } });
  return chart(`${title} against ${name}`, [order.map((index) => drawn[index]), at(true), at(false)], title, [dots("passed", "good"), dots("failed", "bad")], { xLabel: name });
}

/** A chart whose horizontal axis is not time. */
function chart(title, columns, yLabel, series, { x, xLabel } = {}, hook) {
  const node = element("div", { class: "plot" }, element("h4", {}, title));
  let drawn = null;
  const draw = () => {
    if (drawn) drawn.destroy();
    drawn = new uPlot({
      width: node.clientWidth, height: PLOT_HEIGHT + 40,
      scales: { x: { time: false, range: x } },
      axes: [axis(xLabel || title), { ...axis(yLabel), size: 50 }],
      series: [{ label: xLabel || "margin", value: (_, value) => (value === null ? "--" : number(value)) }, ...[series].flat()],
      hooks: hook ? { draw: [hook] } : {},
    }, columns, node);
  };
  whenResized(node, draw);
  whenThemeChanges(() => drawn && draw());
  return node;
}

function zeroLine(chart) {
  const { ctx, bbox } = chart;
  const at = chart.valToPos(0, "x", true);
  ctx.strokeStyle = themed("bad");
  ctx.lineWidth = 2;
  ctx.beginPath();
  ctx.moveTo(at, bbox.top);
  ctx.lineTo(at, bbox.top + bbox.height);
  ctx.stroke();
}

function worstSamples(samples) {
  const order = samples.number.map((_, index) => index).sort((a, b) => samples.failed[b].length - samples.failed[a].length);
  const bad = order.filter((index) => samples.verdict[index] !== "PASS").slice(0, MAX_WORST);
  if (bad.length === 0) return element("p", { class: "muted" }, "No sample failed.");
  const rows = bad.map((index) => [
    { text: String(samples.number[index]), class: "number" }, { text: String(samples.seed[index]), class: "number" },
    samples.verdict[index], samples.failed[index].join(", "),
    samples.drawn.filter(([, values]) => values.some((value) => value !== values[0])).map(([name, values]) => `${name.replace(/ \[.*/, "")} ${number(values[index])}`).join(", "),
  ]);
  return element("div", {}, element("h4", {}, "Worst samples"), table(["sample", "seed", "verdict", "failed checks", "drawn"], rows));
}

function stressContent({ result }) {
  const trials = [...result.trials].sort((a, b) => a.level - b.level);
  const found = result.turns;
  const headline = found
    ? `passes at ${number(found.passes)} ${result.unit}, fails at ${number(found.fails)} ${result.unit} by ${found.red.join(", ")}`
    : trials.every((trial) => trial.passed) ? "passes at every level that was tried" : "fails without the disturbance";
  const rows = trials.map((trial) => [
    { text: number(trial.level), class: "number" }, element("span", { class: `badge ${trial.passed ? "pass" : "fail"}` }, trial.passed ? "pass" : "fail"),
    trial.red.join(", "),
  ]);
  return [element("p", { class: "headline" }, `${result.over}: ${headline}`), table([`${result.over} [${result.unit}]`, "verdict", "failed checks"], rows)];
}

function plainContent({ result }) {
  return [facts(result), ...Object.entries(result).filter(([, value]) => isListOfRecords(value)).map(([name, value]) => recordTable(name, value))];
}

function isListOfRecords(value) {
  return Array.isArray(value) && value.length > 0 && value.every((it) => it !== null && typeof it === "object" && !Array.isArray(it));
}

function recordTable(name, records) {
  const columns = [...new Set(records.flatMap((record) => Object.keys(record)))].filter((column) => records.every((it) => typeof it[column] !== "object" || Array.isArray(it[column])));
  const text = (value) => (typeof value === "number" && !Number.isInteger(value) ? number(value) : Array.isArray(value) ? value.join(", ") : String(value ?? ""));
  return section(name, table(columns, records.slice(0, 100).map((record) => columns.map((column) => text(record[column])))));
}

/** The figures of an object, with its inner objects, as a list of names and values. */
function facts(object, prefix = "") {
  const rows = [];
  const add = (fields, path) => {
    for (const [name, value] of Object.entries(fields)) {
      if (value === null || Array.isArray(value)) continue;
      if (typeof value === "object") add(value, `${path}${name}.`);
      else rows.push([element("code", {}, path + name), { text: typeof value === "number" && !Number.isInteger(value) ? number(value) : String(value), class: "number" }]);
    }
  };
  add(object, prefix);
  return rows.length === 0 ? null : table(["figure", "value"], rows, { class: "facts" });
}
