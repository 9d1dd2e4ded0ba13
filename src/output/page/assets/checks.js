// The verdict as a table: sortable, filtered by status, one row per check.

const STATUS_ORDER = { fail: 0, undecided: 1, pass: 2, skip: 3 };

/** `select(check)` is called when a row is chosen. `old`: the checks of the result that it is compared with, or null. */
class ChecksTable {
  constructor(checks, old, select) {
    this.rows = checks.map((check, index) => ({ check, index, old: old ? old.find((it) => it.name === check.name) : null }));
    this.select = select;
    this.columns = this.columnsOf(checks, old !== null);
    this.sort = { column: this.columns[0], direction: 1 };
    this.filter = "all";
    this.chosen = null;
    this.body = element("tbody");
    this.head = element("tr");
    this.filters = element("div", { class: "filters", role: "group", "aria-label": "filter by status" });
    this.node = element("div", { class: "checks" }, this.filters,
      element("div", { class: "wide" }, element("table", {}, element("thead", {}, this.head), this.body)));
    this.draw();
  }

  columnsOf(checks, isCompared) {
    const bySeverity = ({ check, index }) => STATUS_ORDER[check.status] * 1e4 + (check.advisory ? 5e3 : 0) + index;
    const value = (name) => ({ check }) => check[name] ?? Infinity;
    const figure = (title, name, form) => ({
      title, key: value(name), cell: ({ check }) => ({ text: form(check[name], check.unit), class: "number" }),
    });
    const change = {
      title: "before",
      key: ({ check, old }) => (old ? (check.margin ?? 0) - (old.margin ?? 0) : Infinity),
      cell: ({ check, old }) => ({ text: old ? before(check, old) : "not made", class: "number" }),
    };
    return [
      { title: "status", key: bySeverity, cell: ({ check }) => statusBadge(check) },
      { title: "check", key: ({ check }) => check.name, cell: ({ check }) => element("code", {}, check.name) },
      figure("margin", "margin", signed),
      ...(isCompared ? [change] : []),
      figure("value", "value", number),
      figure("limit", "limit", (it) => (it === undefined || it === null ? "" : String(Number(it.toPrecision(7))))),
      { title: "unit", key: ({ check }) => check.unit, cell: ({ check }) => check.unit },
      { title: "at", key: value("at_s"), cell: ({ check }) => ({ text: seconds(check.at_s), class: "number" }) },
      { title: "between, remarks", key: ({ check }) => (check.between || []).join(), cell: ({ check }) => remarks(check) },
    ];
  }

  draw() {
    const counts = Object.keys(STATUS_ORDER).map((status) => [status, this.rows.filter(({ check }) => check.status === status).length]);
    const filters = [["all", this.rows.length], ...counts].filter(([, count]) => count > 0);
    this.filters.replaceChildren(...filters.map(([status, count]) =>
      element("button", { type: "button", "aria-pressed": String(this.filter === status), onclick: () => this.set({ filter: status }) }, `${status} ${count}`)));
    this.head.replaceChildren(...this.columns.map((column) => {
      const isSorted = this.sort.column === column;
      const order = this.sort.direction > 0 ? "ascending" : "descending";
      const button = element("button", { type: "button", onclick: () => this.sortBy(column) }, column.title, isSorted ? (this.sort.direction > 0 ? " ▲" : " ▼") : "");
      return element("th", { "aria-sort": isSorted ? order : null }, button);
    }));
    const { column, direction } = this.sort;
    const compare = (a, b) => {
      const [x, y] = [column.key(a), column.key(b)];
      return direction * (x < y ? -1 : x > y ? 1 : 0);
    };
    const shown = this.rows.filter(({ check }) => this.filter === "all" || check.status === this.filter);
    this.body.replaceChildren(...[...shown].sort(compare).map((row) => this.row(row)));
  }

  row(row) {
    const { check } = row;
    const cells = this.columns.map(({ cell }) => {
      const content = cell(row);
      const isStyled = content !== null && typeof content === "object" && !(content instanceof Node);
      return element("td", isStyled ? { class: content.class } : {}, isStyled ? content.text : content);
    });
    const choose = () => {
      this.chosen = check.name;
      this.draw();
      this.select(check);
    };
    const isPlaced = check.at_s !== undefined && check.at_s !== null;
    return element("tr", {
      class: `${check.status} ${check.name === this.chosen ? "chosen" : ""}`, "data-check": check.name,
      tabindex: isPlaced ? 0 : null, title: isPlaced ? "show this instant" : null,
      onclick: isPlaced ? choose : undefined, onkeydown: isPlaced ? (event) => event.key === "Enter" && choose() : undefined,
    }, cells);
  }

  set({ filter }) {
    this.filter = filter;
    this.draw();
  }

  sortBy(column) {
    this.sort = { column, direction: this.sort.column === column ? -this.sort.direction : 1 };
    this.draw();
  }
}

function statusBadge(check) {
  return element("span", { class: `badge ${check.status} ${check.advisory ? "advisory" : ""}` }, check.status);
}

function remarks(check) {
  const parts = [[...new Set(check.between || [])].join(" and "), check.reason, check.advisory ? "advisory" : null];
  return parts.filter((part) => part).join("; ");
}

function before(check, old) {
  const status = old.status === check.status ? "" : `${old.status} `;
  return `${status}${signed(old.margin, old.unit)}`;
}
