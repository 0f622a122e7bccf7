// One frame on a canvas: grains, walls, force chains, the path of a grain.

const MEAN_WIDTH = 0.22, MOST_MEANS = 4.5;  // of lines: d for the mean force, and the most of them
const WIDTHS = 18;  // of lines that are told apart
const GROUND = "#e8ebee", WALL = "#262626", GRAIN_CONTACT = "#0072b2", WALL_CONTACT = "#d55e00", PULL = "#cc79a7";
const RIM = 0.04;  // of a radius, left white so that neighbours of one colour are seen apart

// Where the middle of the canvas lies (d), and how many of its own pixels a d takes.
class Camera {
  constructor() { this.x = this.z = 0; this.scale = 1; this.width = this.height = 1; }
  // Below `above` pixels, and there close to them rather than in the middle.
  show([left, right, bottom, top], margin, above = 0) {
    this.x = (left + right) / 2;
    this.scale = Math.min((this.width - 2 * margin) / (right - left), (this.height - above - 2 * margin) / (top - bottom));
    this.z = above ? top - (this.height / 2 - above - margin) / this.scale : (bottom + top) / 2;
  }
  toX(x) { return this.width / 2 + (x - this.x) * this.scale; }
  toY(z) { return this.height / 2 - (z - this.z) * this.scale; }
  ofX(x) { return this.x + (x - this.width / 2) / this.scale; }
  ofY(y) { return this.z - (y - this.height / 2) / this.scale; }
  // Closer by a factor; what is under the pixel stays there.
  zoom(factor, x, y) {
    const before = [this.ofX(x), this.ofY(y)];
    this.scale = Math.min(Math.max(this.scale * factor, 0.02), 2000);
    this.x += before[0] - this.ofX(x);
    this.z += before[1] - this.ofY(y);
  }
}

// The number of a colour for a value, by the scale of the field.
function colourIndex(field) {
  const n = field.colours.length;
  if (field.scale === "log") {
    const low = Math.log(field.low), by = n / (Math.log(field.high) - low);
    return value => value > field.low ? Math.min(n - 1, Math.floor((Math.log(value) - low) * by)) : 0;
  }
  const by = n / (field.high - field.low);
  return value => Math.max(0, Math.min(n - 1, Math.floor((value - field.low) * by)));
}

// The colour between a colour and white, for grains below force chains.
function lighter(colour) {
  return "#" + [1, 3, 5].map(k => Math.round(255 - 0.38 * (255 - parseInt(colour.slice(k, k + 2), 16))).toString(16).padStart(2, "0")).join("");
}

function drawGrains(ctx, camera, run, f, field, light) {
  const frame = run.frames[f], values = run.values(field.name, f), index = colourIndex(field), s = camera.scale;
  const bins = field.colours.map(() => []);
  for (let g = 0; g < run.content.count; g++) {
    if (!frame.there[g]) continue;
    const x = camera.toX(run.x(frame, g)), y = camera.toY(run.z(frame, g)), r = run.radius[g] * s;
    if (x + r < 0 || y + r < 0 || x - r > camera.width || y - r > camera.height) continue;
    bins[index(values[g])].push(x, y, r * (1 - RIM));
  }
  for (let k = 0; k < bins.length; k++) {
    if (!bins[k].length) continue;
    ctx.fillStyle = light ? lighter(field.colours[k]) : field.colours[k];
    ctx.beginPath();
    for (let p = 0; p < bins[k].length; p += 3) {
      ctx.moveTo(bins[k][p] + bins[k][p + 2], bins[k][p + 1]);
      ctx.arc(bins[k][p], bins[k][p + 1], bins[k][p + 2], 0, 2 * Math.PI);
    }
    ctx.fill();
  }
  ctx.fillStyle = run.content.signal;
  ctx.beginPath();
  for (const g of run.content.overlaps[f].flatMap(([, a, b]) => b < 0 ? [a] : [a, b])) {
    const x = camera.toX(run.x(frame, g)), y = camera.toY(run.z(frame, g)), r = run.radius[g] * s;
    ctx.moveTo(x + r, y);
    ctx.arc(x, y, r, 0, 2 * Math.PI);
  }
  ctx.fill();
}

function drawChains(ctx, camera, run, f) {
  const frame = run.frames[f], kinds = { [GRAIN_CONTACT]: [], [WALL_CONTACT]: [], [PULL]: [] };
  const line = (colour, level, x, z, u, w) => {
    const wide = Math.min(Math.abs(run.force(level)) / run.content.mean_force, MOST_MEANS) / MOST_MEANS;
    const k = Math.round(wide * WIDTHS), lines = kinds[level < 0 ? PULL : colour];
    if (!k) return;
    const at = [camera.toX(x), camera.toY(z), camera.toX(x + u), camera.toY(z + w)];
    if (Math.max(at[0], at[2]) < 0 || Math.min(at[0], at[2]) > camera.width || Math.max(at[1], at[3]) < 0 || Math.min(at[1], at[3]) > camera.height) return;
    (lines[k] ||= []).push(...at);
  };
  for (let k = 0; k < frame.a.length; k++) {
    const a = frame.a[k], b = frame.b[k], [u, w] = run.way(frame, a, b);
    const x = run.x(frame, a), z = run.z(frame, a), toX = run.x(frame, b), toZ = run.z(frame, b);
    line(GRAIN_CONTACT, frame.level[k], x, z, u, w);
    // What crosses the seam of a period is seen at both ends.
    if (Math.abs(x + u - toX) > 1e-6 || Math.abs(z + w - toZ) > 1e-6) line(GRAIN_CONTACT, frame.level[k], toX, toZ, -u, -w);
  }
  for (let k = 0; k < frame.wallGrain.length; k++) {
    const g = frame.wallGrain[k], angle = 2 * Math.PI * frame.wallAngle[k] / run.content.angles, r = run.radius[g];
    line(WALL_CONTACT, frame.wallLevel[k], run.x(frame, g), run.z(frame, g), r * Math.cos(angle), r * Math.sin(angle));
  }
  for (const [colour, widths] of Object.entries(kinds)) {
    ctx.strokeStyle = colour;
    widths.forEach((lines, k) => {
      ctx.lineWidth = Math.max(MEAN_WIDTH * MOST_MEANS * k / WIDTHS * camera.scale, 0.35);
      ctx.lineCap = ctx.lineWidth > 2 ? "round" : "butt";  // round ends of hairlines are not seen, and cost
      ctx.beginPath();
      for (let p = 0; p < lines.length; p += 4) { ctx.moveTo(lines[p], lines[p + 1]); ctx.lineTo(lines[p + 2], lines[p + 3]); }
      ctx.stroke();
    });
  }
}

// Shifts by whole periods that bring what lies from low to high into the period.
function shifts(low, high, period) {
  if (!period) return [0];
  const length = period[1] - period[0], found = [];
  for (let k = Math.floor((period[0] - high) / length) + 1; k < (period[1] - low) / length; k++) found.push(k * length);
  return found;
}

function drawContainer(ctx, camera, wall, pixel) {
  ctx.lineWidth = 2 * pixel;
  ctx.beginPath();
  ctx.arc(camera.toX(wall.x), camera.toY(wall.z), wall.radius * camera.scale, 0, 2 * Math.PI);
  ctx.stroke();
  for (let k = 0; k < 12; k++) {  // marks that turn with it, clockwise by its angle
    const angle = -wall.angle + k * Math.PI / 6;
    ctx.lineWidth = (k ? 1.5 : 4) * pixel;
    ctx.beginPath();
    for (const [r, go] of [[1, "moveTo"], [k ? 1.015 : 1.03, "lineTo"]])
      ctx[go](camera.toX(wall.x + r * wall.radius * Math.cos(angle)), camera.toY(wall.z + r * wall.radius * Math.sin(angle)));
    ctx.stroke();
  }
}

function drawWalls(ctx, camera, run, f, pixel) {
  const period = run.content.period, walls = run.frames[f].walls, cell = walls.find(wall => wall.shape === "cell");
  ctx.save();
  ctx.lineCap = "butt";
  ctx.strokeStyle = WALL;
  if (period || cell) {
    ctx.lineWidth = pixel;
    ctx.setLineDash([6 * pixel, 6 * pixel]);
    if (cell) ctx.strokeRect(camera.toX(cell.x[0]), camera.toY(cell.z[1]), (cell.x[1] - cell.x[0]) * camera.scale, (cell.z[1] - cell.z[0]) * camera.scale);
    else for (const x of period) { ctx.beginPath(); ctx.moveTo(camera.toX(x), 0); ctx.lineTo(camera.toX(x), camera.height); ctx.stroke(); }
    ctx.setLineDash([]);
  }
  if (period) {  // beyond one period nothing of a wall is drawn
    ctx.beginPath();
    ctx.rect(camera.toX(period[0]), 0, (period[1] - period[0]) * camera.scale, camera.height);
    ctx.clip();
  }
  for (const wall of walls) {
    if (wall.shape === "container") drawContainer(ctx, camera, wall, pixel);
    ctx.lineWidth = 2 * pixel;
    if (wall.shape === "segment" || wall.shape === "arc") {
      for (const by of shifts(Math.min(...wall.x), Math.max(...wall.x), period)) {
        ctx.beginPath();
        for (let k = 0; k < wall.x.length; k++) ctx[k ? "lineTo" : "moveTo"](camera.toX(wall.x[k] + by), camera.toY(wall.z[k]));
        ctx.stroke();
      }
    }
    if (wall.shape === "disc") {
      for (const by of shifts(wall.x - wall.radius, wall.x + wall.radius, period)) {
        ctx.beginPath();
        ctx.arc(camera.toX(wall.x + by), camera.toY(wall.z), wall.radius * camera.scale, 0, 2 * Math.PI);
        ctx.fillStyle = "#999";
        ctx.fill();
      }
    }
  }
  ctx.restore();
}

// Where a grain has been, and, paler, where it will be; open where it leaves a period at one side.
function drawPath(ctx, camera, run, f, grain, pixel) {
  const half = (range, otherwise) => range ? (range[1] - range[0]) / 2 : otherwise;
  const leaps = (now, before) => {
    const cell = now.walls.find(wall => wall.shape === "cell");
    return Math.abs(run.x(now, grain) - run.x(before, grain)) > half(cell ? cell.x : run.content.period, Infinity) ||
      Math.abs(run.z(now, grain) - run.z(before, grain)) > half(cell && cell.z, Infinity);
  };
  const stroke = (from, to, colour, width) => {
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * pixel;
    ctx.beginPath();
    for (let k = from, open = true; k <= to; k++) {
      const frame = run.frames[k];
      if (!frame.there[grain]) { open = true; continue; }
      const x = run.x(frame, grain), z = run.z(frame, grain);
      if (!open && leaps(frame, run.frames[k - 1])) open = true;
      ctx[open ? "moveTo" : "lineTo"](camera.toX(x), camera.toY(z));
      open = false;
    }
    ctx.stroke();
  };
  ctx.lineCap = ctx.lineJoin = "round";
  for (const [from, to, pale, strong] of [[f, run.frames.length - 1, "#fff", "#8a8f96"], [0, f, "#fff", "#b00000"]]) {
    stroke(from, to, pale, 4);
    stroke(from, to, strong, 2);
  }
  if (!run.frames[f].there[grain]) return;
  ctx.beginPath();
  const r = Math.max(run.radius[grain] * camera.scale, 4 * pixel);
  ctx.arc(camera.toX(run.x(run.frames[f], grain)), camera.toY(run.z(run.frames[f], grain)), r + pixel, 0, 2 * Math.PI);
  ctx.lineWidth = 5 * pixel;
  ctx.strokeStyle = "#fff";
  ctx.stroke();
  ctx.lineWidth = 2.5 * pixel;
  ctx.strokeStyle = "#b00000";
  ctx.stroke();
}

// A bar of 1, 2 or 5 times a power of ten d, below on the left.
function drawScaleBar(ctx, camera, run, pixel) {
  const most = 110 * pixel / camera.scale, power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map(k => k * power).find(l => l <= most), x = 14 * pixel, y = camera.height - 14 * pixel;
  const text = `${shortNumber(length)} d = ${shortNumber(1e3 * length * run.content.scales.length_m)} mm`;
  ctx.lineCap = "butt";
  ctx.lineJoin = "round";
  ctx.font = `${12 * pixel}px system-ui, sans-serif`;
  for (const [colour, wide] of [["rgba(255, 255, 255, .85)", 5], [WALL, 2]]) {
    ctx.lineWidth = wide * pixel;
    ctx.strokeStyle = ctx.fillStyle = colour;
    if (wide === 5) ctx.strokeText(text, x, y - 9 * pixel); else ctx.fillText(text, x, y - 9 * pixel);
    ctx.beginPath();
    ctx.moveTo(x, y - 5 * pixel); ctx.lineTo(x, y); ctx.lineTo(x + length * camera.scale, y); ctx.lineTo(x + length * camera.scale, y - 5 * pixel);
    ctx.stroke();
  }
}

function shortNumber(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [digits, power] = value.toExponential(1).split("e");
    return `${digits.replace(/\.0$/, "")}·10${[...String(+power)].map(c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]).join("")}`;
  }
  return String(+value.toPrecision(3)).replace("-", "−");
}

function drawFrame(ctx, camera, run, shown, pixel) {
  ctx.fillStyle = GROUND;
  ctx.fillRect(0, 0, camera.width, camera.height);
  drawGrains(ctx, camera, run, shown.frame, shown.field, shown.chains);
  drawWalls(ctx, camera, run, shown.frame, pixel);
  if (shown.chains) drawChains(ctx, camera, run, shown.frame);
  if (shown.grain !== null) drawPath(ctx, camera, run, shown.frame, shown.grain, pixel);
  drawScaleBar(ctx, camera, run, pixel);
}
