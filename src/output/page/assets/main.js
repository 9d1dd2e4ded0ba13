// The page: the run at a glance, failures first, and one result at a time.

const page = document.getElementById("page");
const results = resultsFailuresFirst();
const detail = element("main");

function overview() {
  const bad = results.filter(({ run }) => run.verdict !== "pass" || (run.losses || []).length > 0);
  const refused = data.summary ? data.summary.refused : [];
  const isGood = bad.length === 0 && refused.length === 0 && losses().length === 0;
  const isNews = losses().length > 0 && !data.counts.includes("worse");
  const worse = isNews ? "worse than before: " : "";
  const title = data.counts ? element("h1", { class: isGood ? "good" : "bad" }, worse + data.counts) : element("h1", {}, "Campaigns");
  return element("header", { class: "overview" },
    element("p", { class: "muted" }, `harness ${data.harness}`), title,
    refused.length > 0 ? element("ul", { class: "bad" }, refused.flatMap(({ faults }) => faults.map((fault) => element("li", {}, element("code", {}, fault))))) : null,
    results.length > 1 ? resultList() : null,
    comparisonTable());
}

function resultList() {
  const rows = element("tbody");
  const search = element("input", { type: "search", placeholder: "scenario or planner", "aria-label": "filter the results", oninput: draw });
  const onlyBad = element("input", { type: "checkbox", onchange: draw });
  function draw() {
    const wanted = results.filter(({ run, id }) => id.includes(search.value) && (!onlyBad.checked || run.verdict !== "pass" || (run.losses || []).length > 0));
    rows.replaceChildren(...wanted.map(({ run, id }) => element("tr", { class: run.verdict, "data-result": id },
      element("td", {}, verdictBadge(run)),
      element("td", {}, element("a", { href: `#${id}` }, run.scenario)),
      element("td", {}, run.planner),
      element("td", { class: "number" }, quantity(run.flight_time_s, "s")),
      element("td", {}, run.reason))));
  }
  draw();
  return element("div", { class: "results" },
    element("div", { class: "toolbar" }, search, element("label", {}, onlyBad, "only what is not good")),
    element("div", { class: "wide tall" }, element("table", {},
      element("thead", {}, element("tr", {}, ["verdict", "scenario", "planner", "flight time", "why"].map((name) => element("th", {}, name)))), rows)));
}

function comparisonTable() {
  const differences = data.comparison ? data.comparison.differences : [];
  if (!data.comparison) return null;
  const rows = differences.map((it) => [
    element("span", { class: `badge ${{ worse: "fail", better: "pass", note: "undecided" }[it.rating]}` }, it.rating),
    element("a", { href: `#${it.scenario}/${it.planner}` }, `${it.scenario} · ${it.planner}`), it.what,
    { text: it.old, class: "number" }, { text: it.new, class: "number" }, it.change,
  ]);
  const title = `Against ${data.comparison.old || "the baseline"}: ${data.comparison.counts}`;
  return element("details", { class: "comparison", open: rows.length > 0 && rows.length < 40 }, element("summary", {}, title),
    rows.length > 0 ? table(["", "result", "what", "old", "new", "change"], rows) : element("p", { class: "muted" }, "No difference beyond tolerance."));
}

/** Shows the result that the address names, or the first. */
async function showResult() {
  const wanted = decodeURIComponent(window.location.hash.slice(1));
  const result = results.find(({ id }) => id === wanted) || results[0];
  if (!result) return;
  const article = await jobArticle(result);
  detail.replaceChildren(article);
  document.querySelectorAll("[data-result]").forEach((row) => row.classList.toggle("chosen", row.dataset.result === result.id));
  if (wanted) article.scrollIntoView();
  document.documentElement.dataset.shown = result.id;
}

function figureSection() {
  if (data.figures.length === 0) return null;
  const figures = data.figures.map(({ name, svg }) => {
    const image = element("img", { alt: name, src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` });
    return element("figure", { class: "paper" }, image, element("figcaption", {}, name));
  });
  return element("article", { class: "figures" }, element("h2", {}, "Figures"), figures);
}

page.append(overview(), detail, ...data.campaigns.map(campaignSection), ...[figureSection()].filter((it) => it));
window.addEventListener("hashchange", showResult);
showResult();
