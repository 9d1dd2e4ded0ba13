// The shapes of a scene in a picture. Every kind of shape has one function; unknown kinds are left out.

/** Opacity of filled areas. */
const FILL = 0.13;
/** Shapes whose closed outlines are filled. */
const SOLID = ["obstacles", "hidden", "moving", "meshes", "geofences"];

/**
 * Draws a shape.
 *
 * - `pen`: { context, projection, labels, isGhost }
 * - `place`: from the shape's frame to the world, positions in m
 * - `path`: names of the item
 */
function drawShape(pen, shape, path, place = (position) => position) {
  const [kind, content] = Object.entries(shape)[0];
  const draw = SHAPES[kind];
  if (draw) draw(pen, content, path, place);
}

const SHAPES = { lines: drawLines, points: drawPoints, cylinders: drawCylinders, box: drawBox, sphere: drawSphere, triangles: drawTriangles };

function css({ rgb, opacity }, factor = 1) {
  return paint(rgb, opacity * factor);
}

function trace({ context, projection }, strip, place) {
  strip.forEach((position, index) => {
    const [x, y] = projection.point(place(position));
    if (index === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
}

function isClosed(strip) {
  const [first, last] = [strip[0], strip[strip.length - 1]];
  return strip.length > 3 && first.every((value, axis) => value === last[axis]);
}

function drawLines(pen, { strips, paints, radii, label }, path, place) {
  const { context } = pen;
  const isSolid = SOLID.includes(path[0]);
  strips.forEach((strip, index) => {
    if (strip.length === 0) return;
    const colour = paints[Math.min(index, paints.length - 1)];
    context.beginPath();
    trace(pen, strip, place);
    context.lineWidth = Math.max(path[0].startsWith("planned") ? 1.5 : 0.5, 2 * radii[Math.min(index, radii.length - 1)]);
    context.strokeStyle = css(colour);
    context.setLineDash(pen.isGhost ? [6, 5] : path[0] === "open_loop" ? [9, 4] : []);
    context.stroke();
    if (isSolid && isClosed(strip)) {
      context.fillStyle = css(colour, FILL);
      context.fill();
    }
  });
  context.setLineDash([]);
  const strip = strips[strips.length - 1];
  if (label && label.is_shown && strip && strip.length > 0) {
    const middle = strip[0].map((value, axis) => (value + strip[strip.length - 1][axis]) / 2);
    pen.labels.write(label.text, pen.projection.point(place(middle)), css(paints[0]), path[0] === "closest");
  }
}

function drawPoints(pen, { positions_m, paints, radius, labels, are_labels_shown }, path, place) {
  const { context, projection } = pen;
  positions_m.forEach((position, index) => {
    const [x, y] = projection.point(place(position));
    const size = "screen" in radius ? radius.screen : radius.world * projection.scales[0];
    const colour = css(paints[Math.min(index, paints.length - 1)]);
    context.fillStyle = colour;
    context.beginPath();
    context.arc(x, y, size, 0, 2 * Math.PI);
    context.fill();
    if (are_labels_shown && labels[index]) pen.labels.write(labels[index], [x, y], colour, path[0] === "crashed");
  });
}

function drawCylinders(pen, { cylinders, paint: colour, radius }, path, place) {
  const { context, projection } = pen;
  const [right, up] = projection.scales;
  for (const { centre_m, length_m, radius_m, name } of cylinders) {
    const [x, y] = projection.point(place(centre_m));
    context.beginPath();
    if (projection.isSide) context.rect(x - radius_m * right, y - (length_m / 2) * up, 2 * radius_m * right, length_m * up);
    else context.arc(x, y, Math.max(radius_m * right, 0.5), 0, 2 * Math.PI);
    outline(context, colour, radius, path);
    if (name && !projection.isSide) pen.labels.write(name, [x, y], css(colour), false, true);
  }
}

function drawBox(pen, { centre_m, half_size_m, paint: colour, radius, label }, path, place) {
  const { context, projection } = pen;
  const [x, y] = projection.point(place(centre_m));
  const [right, up] = projection.scales;
  const [width, height] = [half_size_m[projection.axes[0]] * right, half_size_m[projection.axes[1]] * up];
  context.beginPath();
  context.rect(x - width, y - height, 2 * width, 2 * height);
  outline(context, colour, radius, path);
  if (label && label.is_shown) pen.labels.write(label.text, [x, y - height], css(colour));
}

function drawSphere(pen, { radius_m, paint: colour, radius }, path, place) {
  const { context, projection } = pen;
  const [x, y] = projection.point(place([0, 0, 0]));
  const [right, up] = projection.scales;
  context.beginPath();
  context.ellipse(x, y, radius_m * right, radius_m * up, 0, 0, 2 * Math.PI);
  outline(context, colour, radius, path);
}

function outline(context, colour, radius, path) {
  context.lineWidth = Math.max(0.7, 2 * radius);
  context.strokeStyle = css(colour);
  context.stroke();
  if (!SOLID.includes(path[0])) return;
  context.fillStyle = css(colour, FILL);
  context.fill();
}

/** Light falls from above: level triangles are bright, upright ones dark. */
function drawTriangles(pen, { triangles, normals, paint: colour }, _path, place) {
  const { context } = pen;
  const origin = place([0, 0, 0]);
  triangles.forEach((corners, index) => {
    const normal = place(normals[index]).map((value, axis) => value - origin[axis]);
    const light = 0.45 + 0.55 * Math.abs(normal[2]);
    context.beginPath();
    trace(pen, corners, place);
    context.closePath();
    context.fillStyle = paint(colour.rgb.map((channel) => channel * light), colour.opacity);
    context.fill();
  });
}
