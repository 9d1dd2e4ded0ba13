// Labels that do not cover each other.

const LABEL_FONT = "12px system-ui, sans-serif";
const LABEL_HEIGHT = 15;

class Labels {
  /** `taken`: rectangles [left, top, right, bottom] that other layers have taken. */
  constructor(context, width, height, taken = []) {
    Object.assign(this, { context, width, height, taken: [...taken] });
  }

  /** Writes beside a point, where there is room; a label that finds none is left out unless `must` is set. */
  write(text, [x, y], colour, must = false, isCentred = false) {
    this.context.font = LABEL_FONT;
    const length = this.context.measureText(text).width;
    const places = isCentred ? [[-length / 2, 4]] : [[10, 4], [-length - 10, 4], [-length / 2, -12], [-length / 2, 22], [10, -12], [10, 20], [-length - 10, -12]];
    const isInside = ([left, top, right, bottom]) => left >= 0 && top >= 0 && right <= this.width && bottom <= this.height;
    const isFree = (box) => this.taken.every((other) => !overlaps(box, other));
    const boxes = places.map(([dx, dy]) => [x + dx, y + dy - LABEL_HEIGHT + 3, x + dx + length, y + dy + 3]);
    const box = boxes.find((candidate) => isInside(candidate) && isFree(candidate)) || (must ? clamped(boxes[0], this) : null);
    if (!box) return;
    this.taken.push(box);
    this.context.lineJoin = "round";
    this.context.lineWidth = 3;
    this.context.strokeStyle = themed("sky");
    this.context.strokeText(text, box[0], box[3] - 3);
    this.context.fillStyle = colour;
    this.context.fillText(text, box[0], box[3] - 3);
  }
}

function overlaps(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

function clamped([left, top, right, bottom], { width, height }) {
  const dx = Math.min(0, width - 4 - right) - Math.min(0, left - 4);
  const dy = Math.min(0, height - 4 - bottom) - Math.min(0, top - 4);
  return [left + dx, top + dy, right + dx, bottom + dy];
}
