// Quantities over time, by uPlot: limits as lines, one cursor for all plots of a result, the player's time.

/** More curves than this have no legend, and are drawn on common times. */
const MAX_LEGEND = 10;
/** Number of common times of many curves: two per interval, so that extremes survive. */
const COMMON_INTERVALS = 300;
const PLOT_HEIGHT = 210;

/** The plots of a scene in tabs. `instants`: [{ t, text, isBad }] to mark. */
function plotTabs(scene, player, instants, key) {
  const names = [...new Set(scene.plots.map((plot) => plot.tab))];
  const panels = names.map((name) => {
    const plots = scene.plots.filter((plot) => plot.tab === name && plot.series.some((series) => series.kind === "quantity"));
    return element("div", { class: "plots" }, plots.map((plot) => timePlot(plot, scene.end_s, player, instants, key)));
  });
  const shown = names.map((name, index) => ({ name, panel: panels[index] })).filter(({ panel }) => panel.childElementCount > 0);
  return shown.map(({ name, panel }) => section(name === "Verdict" ? "Distances and tracking" : name, panel));
}

function timePlot(plot, end, player, instants, key) {
  const quantities = plot.series.filter((series) => series.kind === "quantity");
  const limits = plot.series.filter((series) => series.kind === "limit" && series.values.length > 0);
  const { times, columns } = quantities.length <= MAX_LEGEND ? onAllTimes(quantities) : onCommonTimes(quantities, end);
  const node = element("div", { class: "plot" }, element("h4", {}, plot.title));
  let chart = null;
  const draw = (width) => {
    if (chart) chart.destroy();
    chart = new uPlot(options(), [times, ...columns], node);
    moveCursor();
  };
  const options = () => ({
    width: node.clientWidth,
    height: PLOT_HEIGHT,
    legend: { show: quantities.length <= MAX_LEGEND, live: true },
    cursor: { sync: { key }, points: { size: 6 }, drag: { x: true, y: false } },
    scales: { x: { time: false, range: (u, low, high) => (low === null ? [0, end] : [low, high]) }, y: { range: plot.range || withMargin(quantities, limits) } },
    axes: [axis("time [s]"), { ...axis(), size: 58 }],
    series: [
      { label: "t", value: (_, value) => (value === null ? "--" : seconds(value)) },
      ...quantities.map((series) => ({
        label: series.title,
        stroke: paint(series.colour),
        width: quantities.length > MAX_LEGEND ? 0.8 : 1.5,
        paths: series.is_stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
        points: { show: false },
        spanGaps: true,
        value: (_, value) => (value === null || value === undefined ? "--" : value.toPrecision(5)),
      })),
    ],
    hooks: { draw: [(u) => drawLimits(u, limits), (u) => drawInstants(u, instants)], setSize: [moveCursor], setScale: [moveCursor] },
    plugins: [],
  });
  const cursor = element("div", { class: "now" });
  function moveCursor() {
    if (!chart) return;
    if (cursor.parentNode !== chart.over) chart.over.append(cursor);
    cursor.style.left = `${chart.valToPos(player.time, "x")}px`;
  }
  node.addEventListener("click", (event) => {
    if (chart && chart.over.contains(event.target)) player.pauseAt(chart.posToVal(chart.cursor.left, "x"));
  });
  player.onChange(moveCursor);
  whenResized(node, draw);
  whenThemeChanges(() => chart && draw());
  return node;
}

function axis(label) {
  return {
    label,
    labelSize: label ? 22 : 0,
    labelFont: "12px system-ui, sans-serif",
    font: "11px system-ui, sans-serif",
    stroke: themed("muted"),
    grid: { stroke: themed("grid"), width: 1 },
    ticks: { stroke: themed("grid"), width: 1 },
  };
}

/** Range of all values and limits, with a margin. */
function withMargin(quantities, limits) {
  let [low, high] = [Infinity, -Infinity];
  for (const series of [...quantities, ...limits])
    for (const value of series.values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const margin = high > low ? 0.08 * (high - low) : 1;
  return [low - margin, high + margin];
}

/** Every curve at the times of all of them. */
function onAllTimes(curves) {
  const times = [...new Set(curves.flatMap((series) => series.times_s))].sort((a, b) => a - b);
  return { times, columns: curves.map((series) => times.map((t) => valueAt(series, t))) };
}

function valueAt({ times_s, values, is_stepped }, t) {
  if (times_s.length === 0 || t < times_s[0] || t > times_s[times_s.length - 1]) return null;
  const index = indexAt(times_s, t);
  const next = Math.min(index + 1, times_s.length - 1);
  const span = times_s[next] - times_s[index];
  if (is_stepped || span <= 0) return values[index];
  return values[index] + ((t - times_s[index]) / span) * (values[next] - values[index]);
}

/** Smallest and largest value of every curve in each of the common intervals, in the order in which they come. */
function onCommonTimes(curves, end) {
  const step = end / COMMON_INTERVALS;
  const times = Array.from({ length: 2 * COMMON_INTERVALS }, (_, index) => (index * step) / 2);
  const columns = curves.map(({ times_s, values }) => {
    const column = new Array(times.length).fill(null);
    let from = 0;
    for (let interval = 0; interval < COMMON_INTERVALS; interval++) {
      let to = from;
      while (to < times_s.length && times_s[to] < (interval + 1) * step) to++;
      if (to > from) {
        const inside = values.slice(from, to);
        const [low, high] = [Math.min(...inside), Math.max(...inside)];
        const isRising = inside.indexOf(low) <= inside.indexOf(high);
        [column[2 * interval], column[2 * interval + 1]] = isRising ? [low, high] : [high, low];
      }
      from = to;
    }
    return column;
  });
  return { times, columns };
}

/** Limits as dashed lines with their names. */
function drawLimits(chart, limits) {
  const { ctx, bbox } = chart;
  const ratio = window.devicePixelRatio || 1;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = ctx.fillStyle = themed("bad");
  ctx.lineWidth = 1.2 * ratio;
  ctx.setLineDash([5 * ratio, 4 * ratio]);
  ctx.font = `${11 * ratio}px system-ui, sans-serif`;
  ctx.textAlign = "right";
  let lastY = -Infinity;
  for (const { values, title } of [...limits].sort((a, b) => b.values[0] - a.values[0])) {
    const y = chart.valToPos(values[0], "y", true);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    if (Math.abs(y - lastY) > 12 * ratio) ctx.fillText(title, bbox.left + bbox.width - 4 * ratio, y + (y < bbox.top + 16 * ratio ? 12 : -4) * ratio);
    lastY = y;
  }
  ctx.restore();
}

/** Worst instants as ticks at the lower edge. */
function drawInstants(chart, instants) {
  const { ctx, bbox } = chart;
  const ratio = window.devicePixelRatio || 1;
  ctx.save();
  for (const { t, isBad } of instants) {
    const x = chart.valToPos(t, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.fillStyle = themed(isBad ? "bad" : "good");
    ctx.beginPath();
    ctx.moveTo(x - 4 * ratio, bbox.top + bbox.height);
    ctx.lineTo(x + 4 * ratio, bbox.top + bbox.height);
    ctx.lineTo(x, bbox.top + bbox.height - 8 * ratio);
    ctx.fill();
  }
  ctx.restore();
}
