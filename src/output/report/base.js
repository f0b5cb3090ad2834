// Elements, numbers in words, motion.

const $ = id => document.getElementById(id);
const still = matchMedia("(prefers-reduced-motion: reduce)");

/** An element with attributes and children; a child that is a string is text. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children.filter(child => child !== null));
  return element;
}

/** The same inside the picture of the profile, in the name space of its svg. */
function draw(parent, tag, attributes = {}, text) {
  const element = document.createElementNS(parent.namespaceURI, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** A number with this many significant digits, as one writes it: 6.2978, −2.5 × 10⁻¹³. */
function number(x, digits = 6) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e-4 && size < 10 ** Math.max(digits, 5)) return String(Number(x.toPrecision(digits))).replace("-", "−");
  const [mantissa, power] = x.toExponential(digits - 1).split("e");
  const raised = [...String(Number(power))].map(c => RAISED[c]).join("");
  return `${String(Number(mantissa)).replace("-", "−")} × 10${raised}`;
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** The unit of energy in which the numbers of a span (meV) are short. */
function energyUnit(span) {
  if (span < 1e-9) return { name: "meV", perMev: 1, flat: true };
  if (span < 1e-4) return { name: "neV", perMev: 1e6 };
  if (span < 0.1) return { name: "µeV", perMev: 1e3 };
  if (span < 1e3) return { name: "meV", perMev: 1 };
  return { name: "eV", perMev: 1e-3 };
}

/** Round numbers from low to high, about `count` of them. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 2.5, 5, 10].find(s => s * power >= raw * 0.999);
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(k * step);
  return list;
}
