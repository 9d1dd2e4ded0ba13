// The data in the page.

const data = JSON.parse(document.getElementById("data").textContent);
const unpacked = new Map();

/** A scene by the id of its element, unpacked once; null without an id. */
async function loadScene(id) {
  if (!id) return null;
  if (!unpacked.has(id)) unpacked.set(id, unpack(document.getElementById(id).textContent));
  return unpacked.get(id);
}

async function unpack(base64) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text());
}

/** What a comparison found to be worse. */
function losses() {
  return data.comparison ? data.comparison.differences.filter((it) => it.rating === "worse") : [];
}

/** The runs of the summary with their jobs, failures first. What a comparison made afterwards found is among their losses. */
function resultsFailuresFirst() {
  const runs = data.summary ? data.summary.runs : [];
  for (const run of runs) {
    const own = losses().filter((it) => it.scenario === run.scenario && it.planner === run.planner);
    if ((run.losses || []).length === 0) run.losses = own.map((it) => `${it.what}: ${it.old} before, ${it.new} now`);
  }
  const results = runs.map((run, index) => ({ run, job: data.jobs[index], id: run.folder }));
  const rank = ({ run }) => (run.verdict !== "pass" ? 0 : (run.losses || []).length > 0 ? 1 : 2);
  return results.sort((a, b) => rank(a) - rank(b));
}

/** Index of the last of increasing `times` at or before `t`; 0 before the first. */
function indexAt(times, t) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Position of a body at a time, m, and its attitude as a quaternion; null before its first pose. */
function poseAt(body, t) {
  const times = body.times_s;
  if (times.length === 0) return null;
  const index = indexAt(times, t);
  const next = Math.min(index + 1, times.length - 1);
  const span = times[next] - times[index];
  const fraction = span > 0 ? Math.min(1, Math.max(0, (t - times[index]) / span)) : 0;
  const mix = (a, b) => a.map((value, axis) => value + fraction * (b[axis] - value));
  const position = mix(body.positions_m[index], body.positions_m[next]);
  if (body.attitudes.length === 0) return { position, attitude: null };
  const [from, to] = [body.attitudes[index], body.attitudes[next]];
  const isOpposite = from.reduce((sum, value, axis) => sum + value * to[axis], 0) < 0;
  const mixed = mix(from, isOpposite ? to.map((value) => -value) : to);
  const norm = Math.hypot(...mixed);
  return { position, attitude: mixed.map((value) => value / norm) };
}

/** A vector turned by a unit quaternion (x, y, z, w). */
function rotated([x, y, z], [qx, qy, qz, qw]) {
  const [tx, ty, tz] = [2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)];
  return [
    x + qw * tx + qy * tz - qz * ty,
    y + qw * ty + qz * tx - qx * tz,
    z + qw * tz + qx * ty - qy * tx,
  ];
}
