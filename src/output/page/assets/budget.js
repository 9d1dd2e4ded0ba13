// The margin budget: how the margin is consumed from the planner's nodes to the flight.

/** One picture per quantity: a bar for what every step takes or gives, from the margin before to the margin after it. */
function marginBudgets(budgets) {
  return (budgets || []).map(({ question, unit, rungs }) => {
    const margins = rungs.map((step) => step.margin);
    const [low, high] = [Math.min(0, ...margins), Math.max(0, ...margins)];
    const place = (margin) => (100 * (margin - low)) / (high - low || 1);
    const rows = rungs.map((step, index) => {
      const previous = index === 0 ? 0 : rungs[index - 1].margin;
      const [from, to] = [Math.min(previous, step.margin), Math.max(previous, step.margin)];
      const kind = index === 0 || index === rungs.length - 1 ? (step.margin < 0 ? "bad" : "good") : step.change < 0 ? "loss" : "gain";
      const isTotal = index === 0;
      const text = isTotal ? signed(step.margin, unit) : `${signed(step.change, unit)} → ${signed(step.margin, unit)}`;
      return element("div", { class: "step" },
        element("span", { class: "name" }, step.name),
        element("span", { class: "track" },
          element("i", { class: "zero", style: `left:${place(0)}%` }),
          element("i", { class: `bar ${kind}`, style: `left:${place(from)}%;width:${Math.max(0.4, place(to) - place(from))}%` })),
        element("span", { class: "number" }, `${text} ${unit}`));
    });
    return element("div", { class: "budget" }, element("h4", {}, `${question}: margin from the nodes to the flight [${unit}]`), rows);
  });
}
