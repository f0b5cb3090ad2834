// Colours of directions. "Direction" is a hue circle of even lightness in Oklab (Ottosson 2020): 0° (+x) red, 180° green-blue, as
// in spins.svg; towards +z it fades to a warm white, towards −z to a blue black.

function srgb(linear) {
  const v = clamp(linear, 0, 1);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
}

function oklab(l, a, b, out, at) {
  const long = (l + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const medium = (l - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const short = (l - 0.0894841775 * a - 1.291485548 * b) ** 3;
  out[at] = srgb(4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short);
  out[at + 1] = srgb(-1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short);
  out[at + 2] = srgb(-0.0041960863 * long - 0.7034186147 * medium + 1.707614701 * short);
}

function byDirection(x, y, z, out, at) {
  const across = Math.min(1, Math.hypot(x, y));
  const hue = Math.atan2(y, x) + 0.4363;
  const lightness = z > 0 ? 0.67 + 0.29 * z ** 1.5 : 0.67 - 0.38 * (-z) ** 1.5;
  const chroma = 0.14 * across ** 0.8;
  const tint = z > 0 ? 0.03 * z ** 4 : -0.07 * z ** 4;
  oklab(lightness, chroma * Math.cos(hue), chroma * Math.sin(hue) + tint, out, at);
}

/** The convention of many programs: hue in the plane, white up, black down. */
function byHsl(x, y, z, out, at) {
  const hue = (Math.atan2(y, x) * 6) / Math.PI + 12;
  const light = (1 + z) / 2, reach = Math.min(light, 1 - light);
  [0, 8, 4].forEach((n, c) => {
    const k = (n + hue) % 12;
    out[at + c] = light - reach * Math.max(-1, Math.min(k - 3, 9 - k, 1));
  });
}

/** Blue for −1, white for 0, red for +1, as in spins.svg. */
function diverging(v, out, at) {
  const s = Math.min(Math.abs(v), 1);
  const hue = v < 0 ? 4.4506 : 0.4887;
  const chroma = 0.165 * Math.sin(1.35 * s);
  oklab(0.975 - 0.53 * s ** 1.25, chroma * Math.cos(hue), chroma * Math.sin(hue), out, at);
}

const COLOURS = {
  direction: { words: "direction: hue in the plane, light up (+z), dark down", paint: byDirection },
  z: { words: "m_z: red +, blue −", paint: (x, y, z, out, at) => diverging(z, out, at) },
  x: { words: "m_x: red +, blue −", paint: (x, y, z, out, at) => diverging(x, out, at) },
  y: { words: "m_y: red +, blue −", paint: (x, y, z, out, at) => diverging(y, out, at) },
  hsl: { words: "HSL: hue in the plane, white up, black down", paint: byHsl },
};

const css = (rgb, at) => `rgb(${Math.round(255 * rgb[at])} ${Math.round(255 * rgb[at + 1])} ${Math.round(255 * rgb[at + 2])})`;

/** The three numbers of a colour that the page has resolved, "rgb(59, 65, 71)", from 0 to 1. */
function rgbOf(element) {
  return getComputedStyle(element).color.match(/[\d.]+/g).slice(0, 3).map(c => Number(c) / 255);
}
