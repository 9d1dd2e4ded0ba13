// One result: headline, scene, verdict, series, margin budget, figures.

const LEVELS = { info: "", warning: "warning", error: "bad", critical: "bad" };

/** The article of a result; its scene is unpacked and drawn when it comes. */
async function jobArticle({ run, job, id }) {
  const { report } = job;
  const [scene, oldScene] = await Promise.all([loadScene(job.scene), loadScene(job.old && job.old.scene)]);
  const opening = scene ? report.checks.find((check) => check.name === scene.decisive_check) : null;
  const start = opening && opening.at_s <= scene.end_s ? opening.at_s : scene ? scene.focus_s : 0;
  const player = new Player(scene ? Math.max(scene.end_s, 1e-3) : 1, start);
  const picture = scene ? new ScenePicture(scene, oldScene, report.checks, player) : null;
  const select = (check) => {
    player.pauseAt(check.at_s);
    if (picture) picture.select(check);
  };
  const checks = new ChecksTable(report.checks, job.old ? job.old.report.checks : null, select);
  const instants = report.checks
    .filter((check) => check.at_s !== undefined && (check.status === "fail" || check.status === "undecided" || isKey(check)))
    .map((check) => ({ t: check.at_s, isBad: check.status !== "pass" }));
  const article = element("article", { class: "job", id, "data-start": start },
    jobHeader(run, job),
    picture ? [picture.node, player.node] : element("p", { class: "muted" }, "This run recorded no scene: run it without `--record none`, or with `--html`."),
    section("Verdict", checks.node),
    section("Margin budget", marginBudgets(report.waterfall)),
    scene ? plotTabs(scene, player, instants, id) : null,
    scene ? section("Events", eventList(scene, player)) : null,
    section("Plan and figures", planTable(report), element("details", {}, element("summary", {}, "all figures of report.json"), facts({ metrics: report.metrics, timings: report.timings }))),
    scene ? section("How to read the picture", legendList(scene)) : null);
  if (picture && opening) picture.selected = opening;
  return article;
}

function isKey(check) {
  return /^flight\.(separation|clearance|tracking_max)$/.test(check.name);
}

function jobHeader(run, job) {
  const losses = run.losses || [];
  const claim = run.overclaimed ? "The planner calls this plan solved, but it fails checks of the group plan." : null;
  return element("header", {},
    element("h2", {}, verdictBadge(run), ` ${run.scenario} · ${run.planner}`),
    element("p", { class: "headline" }, run.reason),
    losses.length > 0 ? element("p", { class: "bad" }, `Worse than the baseline: ${losses.join("; ")}`) : null,
    claim ? element("p", { class: "bad" }, claim) : null,
    element("p", { class: "muted links" }, `seed ${run.seed}; flight time ${quantity(run.flight_time_s, "s") || "unknown"}; took ${quantity(run.wall_s, "s")}`,
      job.files.map((file) => [" · ", element("a", { href: `${job.folder}/${file}` }, file)]).flat()));
}

function verdictBadge(run) {
  const isWorse = run.verdict === "pass" && (run.losses || []).length > 0;
  const text = { pass: "PASS", fail: "FAIL", "no-plan": "NO PLAN" }[run.verdict] + (isWorse ? ", worse" : "");
  return element("span", { class: `badge verdict ${isWorse ? "fail" : run.verdict}` }, text);
}

function eventList({ events }, player) {
  const rows = events.map(({ t_s, level, text }) =>
    element("li", { class: LEVELS[level] }, element("button", { type: "button", onclick: () => player.pauseAt(t_s) }, seconds(t_s)), ` ${text}`));
  return rows.length === 0 ? null : element("ol", { class: "events" }, rows);
}

function legendList({ legend, description }) {
  const lines = legend.map((line) => element("li", {}, line.replace(/^- /, "").replaceAll("**", "")));
  return [description ? element("p", {}, description) : null, element("ul", {}, lines)];
}

function planTable({ plan }) {
  const rows = [
    ["the planner says", plan.status + (plan.reason ? `: ${plan.reason}` : "")],
    ["iterations", String(plan.iterations)],
    ["planning time on this machine", quantity(plan.wall_s, "s")],
    ["planning time of the slowest vehicle, each on its own computer", plan.distributed_s > 0 ? quantity(plan.distributed_s, "s") : null],
    ["flight time", quantity(plan.flight_time_s, "s")],
    ["objective", plan.objective === null ? null : number(plan.objective)],
    ["discarded", (plan.alternatives || []).map((it) => it.name).join(", ")],
  ];
  return table(["plan", ""], rows.filter(([, value]) => value), { class: "facts" });
}
