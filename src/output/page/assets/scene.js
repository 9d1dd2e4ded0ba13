// The scene from above and from the side: what never changes in one layer, what moves in another one above it.

/** Layers that can be switched off: their titles and the items that belong to them. */
const LAYERS = [
  ["planned", "planned", ["planned", "planned_load", "alternatives"]],
  ["open_loop", "open loop", ["open_loop"]],
  ["flown", "flown", ["flown", "flown_load"]],
  ["ghost", "before", []],
  ["planner", "planner", ["horizon", "route"]],
  ["wind", "wind", ["wind"]],
  ["safety", "volumes", []],
];
/** Parts of vehicles that are volumes around them. */
const VOLUMES = ["safety", "sensors", "body"];
const SIDE_HEIGHT = 170;

class ScenePicture {
  /** `old`: the scene that this one is compared with, or null. */
  constructor(scene, old, checks, player) {
    Object.assign(this, { scene, old, checks, player, hidden: new Set(), selected: null });
    const extent = this.extent("action");
    const isNorthSouth = extent.max_m[1] - extent.min_m[1] > extent.max_m[0] - extent.min_m[0];
    this.views = [
      new SceneView(this, new Projection([0, 1]), "from above", "east (x)", "north (y)"),
      new SceneView(this, new Projection([isNorthSouth ? 1 : 0, 2]), isNorthSouth ? "from the east" : "from the south",
        isNorthSouth ? "north (y)" : "east (x)", "up (z)"),
    ];
    this.node = element("div", { class: "scene" }, this.toolbar(), this.views.map((view) => view.node));
    player.onChange(() => this.views.forEach((view) => view.drawMoving()));
    whenThemeChanges(() => this.draw());
  }

  /** The box to show, m: what is flown through, or the whole map. */
  extent(which) {
    const map = this.scene.items.find((item) => item.path.join("/") === "map/outline");
    const { centre_m, half_size_m } = map ? map.shape.box : { centre_m: [0, 0, 0], half_size_m: [1, 1, 1] };
    const whole = {
      min_m: centre_m.map((value, axis) => value - half_size_m[axis]),
      max_m: centre_m.map((value, axis) => value + half_size_m[axis]),
    };
    return which === "action" && this.scene.action ? this.scene.action : whole;
  }

  toolbar() {
    const present = new Set([...this.scene.items, ...this.scene.changes, ...this.scene.animations].map((item) => item.path[0]));
    const isThere = ([key, , kinds]) => key === "safety" || (key === "ghost" ? this.old : kinds.some((kind) => present.has(kind)));
    const toggle = ([key, title]) =>
      element("label", { class: `layer ${key}` },
        element("input", { type: "checkbox", checked: true, onchange: (event) => this.show(key, event.target.checked) }), title);
    const button = (text, title, action) =>
      element("button", { type: "button", title, "aria-label": title, onclick: () => this.eachView(action) }, text);
    return element("div", { class: "toolbar" },
      LAYERS.filter(isThere).map(toggle),
      element("span", { class: "spacer" }),
      button("+", "zoom in", (view) => view.zoom(1.4)),
      button("−", "zoom out", (view) => view.zoom(1 / 1.4)),
      button("paths", "show the paths", (view) => view.show("action")),
      button("map", "show the whole map", (view) => view.show("map")));
  }

  show(layer, isShown) {
    if (isShown) this.hidden.delete(layer);
    else this.hidden.add(layer);
    this.draw();
  }

  isHidden(path) {
    return LAYERS.some(([key, , kinds]) => this.hidden.has(key) && kinds.includes(path[0]));
  }

  /** Rings the vehicles of a check at its worst instant. */
  select(check) {
    this.selected = check;
    this.draw();
  }

  eachView(action) {
    this.views.forEach(action);
  }

  draw() {
    this.eachView((view) => view.draw());
  }
}

class SceneView {
  constructor(picture, projection, title, right, up) {
    Object.assign(this, { picture, projection, title, extentName: "action" });
    [this.fixed, this.moving] = [element("canvas"), element("canvas", { "aria-label": `${title}; ${right}; ${up}`, role: "img" })];
    this.caption = element("figcaption");
    this.box = element("div", { class: "layers" }, this.fixed, this.moving);
    this.node = element("figure", { class: projection.isSide ? "side" : "above" }, this.box, this.caption);
    this.axes = `${right} to the right, ${up} upwards`;
    whenResized(this.box, (width) => this.resize(width));
    this.listen();
  }

  resize(width) {
    const { min_m, max_m } = this.picture.extent("action");
    const aspect = (max_m[1] - min_m[1]) / Math.max(max_m[0] - min_m[0], 1e-3);
    const tallest = Math.min(0.95 * width, 0.72 * window.innerHeight);
    const height = this.projection.isSide ? SIDE_HEIGHT : Math.max((width < 600 ? 0.7 : 0.36) * width, Math.min(tallest, aspect * width));
    Object.assign(this, { width, height });
    this.box.style.height = `${height}px`;
    this.projection.fit(this.picture.extent(this.extentName), width, height);
    this.draw();
  }

  listen() {
    let last = null;
    this.moving.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      this.moving.setPointerCapture(event.pointerId);
    });
    this.moving.addEventListener("pointermove", (event) => {
      if (!last) return;
      const { shift } = this.projection;
      this.projection.shift = [shift[0] + event.clientX - last[0], shift[1] + event.clientY - last[1]];
      last = [event.clientX, event.clientY];
      this.draw();
    });
    for (const end of ["pointerup", "pointercancel"]) this.moving.addEventListener(end, () => (last = null));
    this.moving.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 200), [event.offsetX, event.offsetY]);
    }, { passive: false });
  }

  zoom(factor, at = [this.width / 2, this.height / 2]) {
    this.projection.zoomAbout(at, factor);
    this.draw();
  }

  show(extentName) {
    this.extentName = extentName;
    this.projection.reset();
    this.projection.fit(this.picture.extent(extentName), this.width, this.height);
    this.draw();
  }

  /** A pen for a cleared canvas of the size of the picture. */
  pen(canvas, taken) {
    const ratio = window.devicePixelRatio || 1;
    [canvas.width, canvas.height] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    return { context, projection: this.projection, labels: new Labels(context, this.width, this.height, taken) };
  }

  draw() {
    if (!this.width) return;
    const pen = this.pen(this.fixed, []);
    pen.context.fillStyle = themed("sky");
    pen.context.fillRect(0, 0, this.width, this.height);
    const { picture } = this;
    const order = (item) => (item.path[0] === "map" ? 0 : SOLID.includes(item.path[0]) ? 1 : item.path[0] === "closest" ? 3 : 2);
    const items = picture.scene.items.filter((item) => !picture.isHidden(item.path));
    const sorted = items.map((item) => [order(item), item]).sort((a, b) => a[0] - b[0]);
    if (picture.old && !picture.hidden.has("ghost")) {
      const ghosts = picture.old.items.filter((item) => item.path[0] === "flown");
      ghosts.forEach((item) => drawShape({ ...pen, isGhost: true }, item.shape, ["ghost"]));
    }
    for (const [, item] of sorted) {
      const isAxisName = item.path.join("/") === "map/axes" && this.projection.isSide;
      if (!isAxisName) drawShape(pen, item.shape, item.path);
    }
    this.drawSelected(pen);
    this.drawScaleBar(pen);
    this.taken = pen.labels.taken;
    const stretched = this.projection.exaggeration > 1.01 ? `; heights ${this.projection.exaggeration.toFixed(1)} times enlarged` : "";
    this.caption.textContent = `Seen ${this.title}: ${this.axes}${stretched}`;
    this.drawMoving();
  }

  /** Rings at the vehicles that the selected check names, at its worst instant. */
  drawSelected({ context, projection, labels }) {
    const check = this.picture.selected;
    if (!check || check.at_s === undefined) return;
    const isBad = check.status === "fail" || check.status === "undecided";
    const colour = themed(isBad ? "bad" : "good");
    let isFirst = true;
    for (const body of this.picture.scene.bodies.filter((body) => (check.between || []).includes(body.frame))) {
      const pose = poseAt(body, check.at_s);
      if (!pose) continue;
      const [x, y] = projection.point(pose.position);
      context.lineWidth = 2.5;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(x, y, 12, 0, 2 * Math.PI);
      context.stroke();
      if (isFirst) labels.write(`${check.name} ${seconds(check.at_s)}`, [x + 8, y], colour);
      isFirst = false;
    }
  }

  drawScaleBar({ context, projection, labels }) {
    const length_m = roundBelow((0.22 * this.width) / projection.scales[0]);
    const length = length_m * projection.scales[0];
    const [x, y] = [12, this.height - 12];
    context.strokeStyle = themed("muted");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, y - 4);
    context.lineTo(x, y);
    context.lineTo(x + length, y);
    context.lineTo(x + length, y - 4);
    context.stroke();
    labels.write(`${length_m} m`, [x + length, y], themed("muted"));
  }

  drawMoving() {
    if (!this.width) return;
    const { picture } = this;
    const t = picture.player.time;
    const pen = this.pen(this.moving, this.taken);
    for (const { path, shapes } of picture.scene.changes) {
      if (picture.isHidden(path) || shapes.length === 0 || shapes[0][0] > t) continue;
      drawShape(pen, shapes[indexAt(shapes.map(([from]) => from), t)][1], path);
    }
    for (const animation of picture.scene.animations) if (!picture.isHidden(animation.path)) drawAnimation(pen, animation, t);
    if (picture.old && !picture.hidden.has("ghost")) picture.old.bodies.forEach((body) => drawGhost(pen, body, t));
    picture.scene.bodies.forEach((body) => drawBody(pen, body, t, picture.hidden.has("safety")));
  }
}

function drawAnimation(pen, { path, times_s, strips, paints, radius }, t) {
  if (times_s.length === 0 || times_s[0] > t) return;
  const index = indexAt(times_s, t);
  const colour = paints[Math.min(index, paints.length - 1)];
  drawShape(pen, { lines: { strips: [strips[index]], paints: [colour], radii: [radius], label: null } }, path);
}

/** The parts of a body; where heights are enlarged, a dot for all of them and its name. */
function drawBody(pen, body, t, areVolumesHidden) {
  const pose = poseAt(body, t);
  if (!pose) return;
  const isStretched = pen.projection.exaggeration > LEAST_EXAGGERATION;
  const isVehicle = body.kind === "vehicle";
  for (const part of body.parts) {
    const isVolume = VOLUMES.includes(part.name);
    if (isVolume && (areVolumesHidden || isStretched)) continue;
    if (isStretched && isVehicle && part.rotates) drawDot(pen, pose.position, part.shape);
    else drawShape(pen, part.shape, body.path, (position) => placed(position, pose, part.rotates));
  }
}

function placed(position, { position: origin, attitude }, rotates) {
  const turned = rotates && attitude ? rotated(position, attitude) : position;
  return turned.map((value, axis) => value + origin[axis]);
}

function drawDot({ context, projection }, position, shape) {
  const content = Object.values(shape)[0];
  const [x, y] = projection.point(position);
  context.fillStyle = css(content.paint || content.paints[0]);
  context.beginPath();
  context.arc(x, y, 4, 0, 2 * Math.PI);
  context.fill();
}

function drawGhost({ context, projection }, body, t) {
  const pose = body.kind === "vehicle" ? poseAt(body, t) : null;
  if (!pose) return;
  const [x, y] = projection.point(pose.position);
  context.strokeStyle = themed("muted");
  context.lineWidth = 1.5;
  context.setLineDash([3, 3]);
  context.beginPath();
  context.arc(x, y, 7, 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
}
