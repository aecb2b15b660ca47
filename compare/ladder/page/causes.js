// ---- causes.js: draws the false-color image of the main cause in each pixel.

const causeNames = data.report.shares.map(share => share.title);
const swatch = i => make("span", { class: "swatch", style: `background:rgb(${data.colors[i].join(",")})` });

// Each function returns whether the pattern of a cause darkens a pixel. Each cause has its own pattern, for users who
// do not see colors.
const patterns = [
  (x, y) => (x + y) % 8 < 2, (x, y) => (x - y + 32768) % 8 < 2, x => x % 6 < 2, (x, y) => y % 6 < 2,
  (x, y) => x % 6 < 3 && y % 6 < 3, (x, y) => (x + y) % 8 < 2 || (x - y + 32768) % 8 < 2,
  (x, y) => x % 8 < 2 || y % 8 < 2, () => false];

class CauseView {
  constructor(cause, steps) {
    this.cause = cause;
    this.steps = steps;
    this.alone = -1; // the only cause that is shown, or −1
    this.patterned = false;
    this.canvas = element("cause");
    this.canvas.width = width;
    this.canvas.height = height;
    this.at = { x: width >> 1, y: height >> 1 };
    this.listen();
    this.paint();
  }

  listen() {
    this.canvas.addEventListener("pointermove", event => {
      const box = this.canvas.getBoundingClientRect();
      this.read((event.clientX - box.left) / box.width * width, (event.clientY - box.top) / box.height * height);
    });
    this.canvas.addEventListener("keydown", event => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!way) return;
      event.preventDefault();
      const by = event.shiftKey ? 10 : 1;
      this.read(this.at.x + way[0] * by, this.at.y + way[1] * by);
      this.paint();
    });
    for (const event of ["focus", "blur"]) this.canvas.addEventListener(event, () => this.paint());
  }

  show(alone) { this.alone = this.alone === alone ? -1 : alone; this.paint(); }

  // Paints as cause_image() in compare/ladder/shares.cpp does: invisible differences are dark.
  paint() {
    const context = this.canvas.getContext("2d"), picture = context.createImageData(width, height);
    for (let i = 0; i < pixelCount; ++i) {
      const cause = this.cause[i], x = i % width, y = (i - x) / width;
      let light = this.steps[i] < data.visible_steps ? 0.12 : 0.35 + 0.65 * Math.min(this.steps[i] / 24, 1);
      if (this.alone >= 0 && cause !== this.alone) light *= 0.12;
      if (this.patterned && patterns[cause](x, y)) light *= 0.45;
      for (let c = 0; c < 3; ++c) picture.data[4 * i + c] = data.colors[cause][c] * light;
      picture.data[4 * i + 3] = 255;
    }
    context.putImageData(picture, 0, 0);
    if (document.activeElement !== this.canvas) return;
    context.strokeStyle = "#fff";
    context.strokeRect(this.at.x - 3.5, this.at.y - 3.5, 8, 8);
  }

  read(x, y) {
    this.at = { x: clamp(Math.floor(x), 0, width - 1), y: clamp(Math.floor(y), 0, height - 1) };
    const i = this.at.y * width + this.at.x, steps = this.steps[i];
    fill("readout", `(${this.at.x}, ${this.at.y})  `, swatch(this.cause[i]), make("b", {}, causeNames[this.cause[i]]),
      `: the images differ by ${steps} of 255 steps` + (steps < data.visible_steps ? ", nothing to be seen" : ""));
  }
}

async function showCauses() {
  const view = new CauseView(...await Promise.all([decodePlane(data.cause, 1), decodePlane(data.steps, 1)]));
  const buttons =
      causeNames.map((name, i) => make("button", {type: "button", "aria-pressed": "false"}, swatch(i), name));
  buttons.forEach((button, i) => button.addEventListener("click", () => {
    view.show(i);
    buttons.forEach((b, k) => b.setAttribute("aria-pressed", String(k === view.alone)));
  }));
  fill("legend", ...buttons);
  element("patterns").addEventListener("change", event => { view.patterned = event.target.checked; view.paint(); });
}
