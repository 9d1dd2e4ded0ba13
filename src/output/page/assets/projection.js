// From metres to points on the screen, as seen from above or from the side.

/** Space around what is shown, as a fraction of the picture. */
const MARGIN = 0.07;
/** Below this, the vertical axis of the side view has the scale of the horizontal one. */
const LEAST_EXAGGERATION = 2;
/** Beyond this, a level flight would look like mountains. */
const MOST_EXAGGERATION = 20;

class Projection {
  /** `axes`: the world's axes that run to the right and upwards: [0, 1] from above, [0 or 1, 2] from the side. */
  constructor(axes) {
    this.axes = axes;
    this.zoom = 1;
    this.shift = [0, 0];
  }

  get isSide() {
    return this.axes[1] === 2;
  }

  /** Fits a box of the world, m, into a picture of `width` times `height` points. */
  fit({ min_m, max_m }, width, height) {
    [this.width, this.height] = [width, height];
    const size = this.axes.map((axis) => Math.max(max_m[axis] - min_m[axis], 1e-3));
    this.centre = this.axes.map((axis) => (min_m[axis] + max_m[axis]) / 2);
    const usable = 1 - 2 * MARGIN;
    const scales = [(usable * width) / size[0], (usable * height) / size[1]];
    const equal = Math.min(...scales);
    const isStretched = this.isSide && scales[1] / equal > LEAST_EXAGGERATION;
    this.scale = isStretched ? [equal, Math.min(scales[1], MOST_EXAGGERATION * equal)] : [equal, equal];
  }

  /** How many times larger the vertical scale is. */
  get exaggeration() {
    return this.scale[1] / this.scale[0];
  }

  /** Points per metre to the right and upwards. */
  get scales() {
    return this.scale.map((scale) => scale * this.zoom);
  }

  /** A position in the world, m, in the picture, points from its upper left corner. */
  point(position) {
    const [right, up] = this.scales;
    return [
      this.width / 2 + this.shift[0] + (position[this.axes[0]] - this.centre[0]) * right,
      this.height / 2 + this.shift[1] - (position[this.axes[1]] - this.centre[1]) * up,
    ];
  }

  /** Zooms about a point of the picture. */
  zoomAbout([x, y], factor) {
    const zoom = Math.min(400, Math.max(0.2, this.zoom * factor));
    const actual = zoom / this.zoom;
    const [fromX, fromY] = [this.width / 2 + this.shift[0], this.height / 2 + this.shift[1]];
    this.shift = [this.shift[0] + (x - fromX) * (1 - actual), this.shift[1] + (y - fromY) * (1 - actual)];
    this.zoom = zoom;
  }

  reset() {
    [this.zoom, this.shift] = [1, [0, 0]];
  }
}
