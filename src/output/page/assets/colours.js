// Colours of scenes and series on a dark and on a light background.

const prefersLight = window.matchMedia("(prefers-color-scheme: light)");
let isPrinted = false;
const themeListeners = new Set();

/** Calls `redraw` when the background changes: by the system's setting, and for print. */
function whenThemeChanges(redraw) {
  themeListeners.add(redraw);
}

function themeChanged() {
  themeListeners.forEach((redraw) => redraw());
}

prefersLight.addEventListener("change", themeChanged);
window.addEventListener("beforeprint", () => {
  isPrinted = true;
  themeChanged();
});
window.addEventListener("afterprint", () => {
  isPrinted = false;
  themeChanged();
});

function isLight() {
  return isPrinted || prefersLight.matches;
}

/** Value of a custom property of the style sheet; that of light paper in print. */
function themed(name) {
  const style = getComputedStyle(document.documentElement);
  return style.getPropertyValue(isPrinted ? `--paper-${name}` : `--${name}`).trim() || style.getPropertyValue(`--${name}`);
}

/** A colour of a scene, [red, green, blue] made for a dark background, as CSS; darker on a light one. */
function paint(rgb, opacity = 1) {
  const luminance = (0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]) / 255;
  let [r, g, b] = rgb;
  if (isLight()) {
    const factor = Math.min(1, 0.46 / Math.max(luminance, 0.01));
    [r, g, b] = luminance < 0.3 ? rgb.map((c) => 255 - 0.5 * (160 - c)) : rgb.map((c) => c * factor);
  }
  return `rgba(${Math.round(r)},${Math.round(g)},${Math.round(b)},${opacity})`;
}
