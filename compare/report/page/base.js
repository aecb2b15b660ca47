// ---- base.js: defines what all pages of the compare tool share: data, elements, theme, number formatting.

const data = JSON.parse(document.getElementById("data").textContent);
const element = id => document.getElementById(id);
const clamp = (v, low, high) => Math.min(Math.max(v, low), high);

// Creates an element with attributes and children. Strings become text nodes, so data is never parsed as HTML.
function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}
function fill(id, ...children) { element(id).replaceChildren(...children); }

// ---- The theme is the system's, or the one chosen with the button #theme and stored in the page's URL (#theme=dark).

const themes = { auto: "light", light: "dark", dark: "auto" }; // maps each theme to the next one
const themeNow = () => document.documentElement.dataset.theme || "auto";

function showTheme(theme) {
  if (theme === "light" || theme === "dark") document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  element("theme").textContent = `Theme: ${themeNow()}`;
}

// This is the fragment of the URL (after the #), as this page last read or wrote it.
let knownHash = location.hash;

// Replaces the URL's fragment by these [key, value] pairs, and the theme if one is chosen. Does nothing while a
// fragment that the user has just entered is still unread, because its hashchange event comes later.
function setAddress(pairs) {
  if (location.hash !== knownHash) return;
  const parts = [...pairs, ...(themeNow() === "auto" ? [] : [["theme", themeNow()]])].map(
      ([key, value]) => `${key}=${encodeURIComponent(value)}`);
  history.replaceState(null, "", parts.length ? "#" + parts.join("&") : location.pathname + location.search);
  knownHash = location.hash;
}
const addressPairs = () => [...new URLSearchParams(location.hash.slice(1))].filter(([key]) => key !== "theme");

// Calls `themeChanged` after the button has changed the theme, for canvases that are drawn in its colors.
function startTheme(themeChanged = () => {}) {
  const read = () => {
    knownHash = location.hash;
    showTheme(new URLSearchParams(location.hash.slice(1)).get("theme"));
    themeChanged();
  };
  read();
  window.addEventListener("hashchange", read);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => themeChanged());
  element("theme").addEventListener("click", () => {
    showTheme(themes[themeNow()]);
    setAddress(addressPairs());
    themeChanged();
  });
}

// Returns one of base.css's colors in the current theme, for example themeColor("raster").
const themeColor = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// ---- Numbers as text, with a true minus sign.

const minus = text => String(text).replaceAll("-", "−");

// Formats a radiance with about four significant digits.
function radianceText(v) {
  if (Number.isNaN(v)) return "NaN";
  if (!Number.isFinite(v)) return v > 0 ? "∞" : "−∞";
  const size = Math.abs(v);
  return minus(size === 0 ? "0" : size >= 1000 ? v.toFixed(0) : size >= 100 ? v.toFixed(1) : size >= 10 ? v.toFixed(2)
    : size >= 1 ? v.toFixed(3) : size >= 0.00005 ? v.toFixed(4) : v.toExponential(0));
}
const signedText = v => (v > 0 ? "+" : "") + radianceText(v);

const superscripts = {
  "-": "⁻",
  0: "⁰",
  1: "¹",
  2: "²",
  3: "³",
  4: "⁴",
  5: "⁵",
  6: "⁶",
  7: "⁷",
  8: "⁸",
  9: "⁹"
};
const powerText = exponent => `10${[...String(exponent)].map(d => superscripts[d]).join("")}`;

// Formats a metric with three or four digits, and small and large values with a power of ten.
function figure(v) {
  if (v === null || v === undefined) return "none";
  const size = Math.abs(v);
  if (size !== 0 && (size < 0.001 || size >= 1e6)) {
    const [factor, exponent] = v.toExponential(2).split("e");
    return (factor === "1.00" ? "" : `${minus(factor)}\u00a0·\u00a0`) + powerText(Number(exponent));
  }
  return minus(
      size === 0       ? "0" :
          size >= 100  ? v.toFixed(1) :
          size >= 10   ? v.toFixed(2) :
          size >= 1    ? v.toFixed(3) :
          size >= 0.01 ? v.toFixed(4) :
                         v.toPrecision(3));
}

// Formats a round number exactly, such as 0.5, −1 or 10⁻⁵.
const roundText = v => v !== 0 && Math.abs(v) < 0.001 ? figure(v) : minus(String(Number(v.toPrecision(3))));

// Formats a fraction as a percentage that is never rounded to 0 % or 100 %.
function percentText(share) {
  if (share === 0 || share === 1) return `${share * 100} %`;
  if (share > 0 && share < 0.0001) return "< 0.01 %";
  return minus(
      share > 0.999 && share < 1 ? `${(Math.floor(share * 1e5) / 1e3).toFixed(3)} %` : `${(share * 100).toFixed(2)} %`);
}

function secondsText(s) {
  if (s < 0.0005) return `${(s * 1e6).toFixed(0)} µs`;
  if (s < 0.01) return `${(s * 1e3).toFixed(1)} ms`;
  if (s < 0.9995) return `${(s * 1e3).toFixed(0)} ms`;
  if (s < 59.95) return `${s.toFixed(s < 10 ? 2 : 1)} s`;
  const whole = Math.round(s);
  return whole < 3600 ? `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`
    : `${Math.floor(whole / 3600)} h ${String(Math.floor(whole / 60) % 60).padStart(2, "0")} min`;
}
const ratioText = r => r >= 10 ? r.toFixed(0) : r.toFixed(1);
const countText = n => Number(n).toLocaleString("en").replaceAll(",", "\u2009");
const countOf = (n, word) => `${countText(n)} ${word}${n === 1 ? "" : "s"}`;
