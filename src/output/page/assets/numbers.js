// Numbers with their units, as in the terminal and in summary.md.

const COUNTED = ["crashes", "numbers", "vehicles"];

/** A measured value: three digits after the point, or scientific notation if it would be rounded to zero. */
function number(value, unit = "") {
  if (value === null || value === undefined) return "";
  if (!Number.isFinite(value)) return String(value);
  if (COUNTED.includes(unit) && Number.isInteger(value)) return value.toFixed(0);
  if (value !== 0 && Math.abs(value) < 5e-4) return value.toExponential(1);
  return value.toFixed(3);
}

/** With its sign. */
function signed(value, unit = "") {
  if (value === null || value === undefined) return "";
  return (value < 0 || Object.is(value, -0) ? "" : "+") + number(value, unit);
}

/** With its unit. */
function quantity(value, unit) {
  const text = number(value, unit);
  return text === "" || unit === "" || unit === "-" ? text : `${text} ${unit}`;
}

function seconds(value) {
  return value === null || value === undefined ? "" : `${value.toFixed(2)} s`;
}

/** The largest of 1, 2, 5, 10, ... that is at most `value`. */
function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].find((digit) => digit * power <= value) * power;
}
