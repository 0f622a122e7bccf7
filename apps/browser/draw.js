// Drawing: the grains, coloured by their speed, and the profile of the velocity.
"use strict";

const SHADES = 48;
const VIRIDIS = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];
const SHADE = Array.from({length: SHADES}, (_, k) => {
  const at = k / (SHADES - 1) * (VIRIDIS.length - 1), low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return pixel(VIRIDIS[low].map((a, c) => Math.round(a + (VIRIDIS[low + 1][c] - a) * (at - low))));
});
const ROW = 5;  // numbers of a grain
const sheet = {};  // pixels of the grains: a canvas without a graphics card fills thousands of paths slowly
let fastest = 1;  // speed of the last shade, which follows the fastest twentieth slowly

// A canvas in the pixels of the screen, emptied.
function fresh(canvas) {
  const ratio = window.devicePixelRatio || 1, {width, height} = canvas.getBoundingClientRect();
  const size = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const at = canvas.getContext("2d");
  at.setTransform(ratio, 0, 0, ratio, 0, 0);
  at.clearRect(0, 0, width, height);
  return {at, width, height, ratio};
}
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// An opaque colour as a canvas keeps it in memory.
function pixel([red, green, blue]) {
  return (255 << 24 | blue << 16 | green << 8 | red) >>> 0;
}
function pixel_of(at, words) {
  at.fillStyle = words;
  const [red, green, blue] = at.fillStyle.match(/\w\w/g).map(part => parseInt(part, 16));
  return pixel([red, green, blue]);
}

// A pixel of the sheet that a colour covers in part.
function blend(place, cover, share) {
  const to = Math.round(256 * share), of = 256 - to, under = sheet.pixels[place], RED_BLUE = 0xff00ff, GREEN = 0xff00;
  const red_blue = (under & RED_BLUE) * of + (cover & RED_BLUE) * to, green = (under & GREEN) * of + (cover & GREEN) * to;
  sheet.pixels[place] = 255 << 24 | red_blue >>> 8 & RED_BLUE | green >>> 8 & GREEN;
}

// A disc on the sheet, in its pixels; rows end in parts of one.
function disc(x, y, r, cover) {
  const {pixels, width, left, top, right, bottom} = sheet, end = Math.min(bottom, Math.ceil(y + r - 0.5));
  for (let row = Math.max(top, Math.ceil(y - r - 0.5)); row < end; row++) {
    const half = Math.sqrt(r * r - (row + 0.5 - y) ** 2), from = x - half, to = x + half, start = row * width;
    const first = Math.floor(from), last = Math.floor(to);
    if (first >= left && first < right) blend(start + first, cover, Math.min(first + 1, to) - from);
    if (last > first && last >= left && last < right) blend(start + last, cover, to - last);
    for (let p = start + Math.max(left, first + 1), stop = start + Math.min(right, last); p < stop; p++) pixels[p] = cover;
  }
}

// A grain and, near a border of a cell, its images.
function each_image(x, z, radius, cell, visit) {
  if (!cell) return visit(x, z);
  const [left, bottom, length, height, offset] = cell;
  for (const up of [-1, 0, 1]) {
    const b = z + up * height;
    if (b <= bottom - radius || b >= bottom + height + radius) continue;
    const from = x + up * offset;
    for (let a = from + Math.ceil((left - radius - from) / length) * length; a < left + length + radius; a += length) visit(a, b);
  }
}

function draw() {
  const {picture} = shown;
  if (!picture) return;
  const {at, width, height, ratio} = fresh($("grains")), {grains, radius, angle, cell} = picture;
  const [left, bottom, wide, high] = cell ?? [-radius, -radius, 2 * radius, 2 * radius];
  const scale = Math.min((width - 24) / wide, (height - 24) / high);
  const toX = x => width / 2 + (x - left - wide / 2) * scale, toY = z => height / 2 - (z - bottom - high / 2) * scale;
  if (sheet.width !== at.canvas.width || sheet.height !== at.canvas.height) {
    const image = new ImageData(at.canvas.width, at.canvas.height);
    Object.assign(sheet, {image, pixels: new Uint32Array(image.data.buffer), width: image.width, height: image.height});
  }
  const corner = (x, z) => [Math.round(ratio * toX(x)), Math.round(ratio * toY(z))];
  const begin = corner(left, bottom + high), end = corner(left + wide, bottom);
  Object.assign(sheet, {left: begin[0], top: begin[1], right: end[0], bottom: end[1]});
  const ground = pixel_of(at, colour("--ground"));
  sheet.pixels.fill(0);
  if (cell)
    for (let row = sheet.top * sheet.width; row < sheet.bottom * sheet.width; row += sheet.width) sheet.pixels.fill(ground, row + sheet.left, row + sheet.right);
  else disc(ratio * toX(0), ratio * toY(0), ratio * radius * scale, ground);
  const speeds = new Float32Array(grains.length / ROW);
  for (let g = 0; g < speeds.length; g++) speeds[g] = Math.hypot(grains[g * ROW + 3], grains[g * ROW + 4]);
  const high_speed = speeds.slice().sort()[Math.floor(0.95 * speeds.length)] || 1;
  fastest += 0.1 * (Math.max(high_speed, 0.2) - fastest);
  for (let g = 0; g < speeds.length; g++) {
    const r = grains[g * ROW + 2], shade = SHADE[Math.min(SHADES - 1, Math.floor(speeds[g] / fastest * SHADES))];
    each_image(grains[g * ROW], grains[g * ROW + 1], r, cell, (x, z) => disc(ratio * toX(x), ratio * toY(z), ratio * r * scale, shade));
  }
  at.putImageData(sheet.image, 0, 0);
  at.strokeStyle = colour("--wall");
  at.lineWidth = 4;
  at.beginPath();
  if (cell) at.lineWidth = 1.5, at.setLineDash([6, 4]), at.rect(toX(left), toY(bottom + high), wide * scale, high * scale);
  else at.arc(toX(0), toY(0), radius * scale + 2, 0, 2 * Math.PI);
  at.stroke();
  at.setLineDash([]);
  if (cell) return;
  at.fillStyle = colour("--wall");
  for (let k = 0; k < 8; k++) {  // marks on the drum show its turn
    const turn = k * Math.PI / 4 - angle, r = radius * scale + 7;
    at.beginPath();
    at.arc(toX(0) + r * Math.cos(turn), toY(0) - r * Math.sin(turn), k === 0 ? 4 : 2.5, 0, 2 * Math.PI);
    at.fill();
  }
}

// What was measured: numbers with their intervals, and the profile.
function tell() {
  const {measured} = shown, kind = KINDS[shown.kind];
  $("numbers").innerHTML = kind.numbers.map(([name, words, unit]) => {
    const {value = NaN, ci99 = NaN} = measured?.[name] ?? {}, digits = Math.abs(value) < 1 ? 3 : 1;
    const number = Number.isFinite(value) ? value.toFixed(digits) : "&ndash;";
    return `<div><dt>${words}</dt><dd id="value-${name}">${number}${Number.isFinite(value) ? unit : ""}`
      + `${Number.isFinite(ci99) && measured.snapshots >= 20 ? ` <small>&plusmn; ${ci99.toFixed(digits)}</small>` : ""}</dd></div>`;
  }).join("");
  plot(measured?.z ? measured : null, kind.axis);
}

// Numbers of an axis: round ones, some five.
function ticks(low, high) {
  const rough = (high - low) / 5, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= rough);
  return Array.from({length: Math.floor(high / step) - Math.ceil(low / step) + 1}, (_, k) => (Math.ceil(low / step) + k) * step);
}

function plot(profile, axis) {
  const {at, width, height} = fresh($("profile")), box = {left: 46, right: width - 12, top: 10, bottom: height - 38};
  at.font = "12px system-ui, sans-serif";
  at.fillStyle = at.strokeStyle = colour("--text");
  at.textAlign = "center";
  at.fillText("velocity v_x / √(gd)", (box.left + box.right) / 2, height - 6);
  at.save();
  at.translate(12, (box.top + box.bottom) / 2);
  at.rotate(-Math.PI / 2);
  at.fillText(axis, 0, 0);
  at.restore();
  const layers = profile ? Array.from(profile.z, (_, k) => k).filter(k => Number.isFinite(profile.v_x[k])) : [];
  if (layers.length < 2) return at.fillText("measured after some steps", (box.left + box.right) / 2, (box.top + box.bottom) / 2);
  const of = (name, k) => profile[name][k] || 0, z = layers.map(k => profile.z[k]);
  const low = Math.min(0, ...layers.map(k => of("v_x", k))), high = Math.max(0.1, ...layers.map(k => of("v_x", k)));
  const margin = 0.06 * (high - low), range = [low - margin, high + margin, Math.min(...z) - 0.5, Math.max(...z) + 0.5];
  const toX = v => box.left + (v - range[0]) / (range[1] - range[0]) * (box.right - box.left);
  const toY = h => box.bottom - (h - range[2]) / (range[3] - range[2]) * (box.bottom - box.top);
  at.lineWidth = 1;
  for (const v of ticks(range[0], range[1])) line(at, colour("--grid"), [[toX(v), box.top], [toX(v), box.bottom]]), at.fillText(+v.toPrecision(3), toX(v), box.bottom + 15);
  at.textAlign = "right";
  for (const h of ticks(range[2], range[3])) line(at, colour("--grid"), [[box.left, toY(h)], [box.right, toY(h)]]), at.fillText(+h.toPrecision(3), box.left - 5, toY(h) + 4);
  at.save();
  at.beginPath();
  at.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  at.clip();
  if (profile.snapshots >= 20) {
    const side = sign => layers.map(k => [toX(of("v_x", k) + sign * of("v_x_ci99", k)), toY(profile.z[k])]);
    at.beginPath();
    [...side(1), ...side(-1).reverse()].forEach(([x, y], k) => k ? at.lineTo(x, y) : at.moveTo(x, y));
    at.fillStyle = colour("--band");
    at.fill();
  }
  at.lineWidth = 2;
  line(at, colour("--line"), layers.map(k => [toX(of("v_x", k)), toY(profile.z[k])]));
  at.restore();
}

function line(at, style, points) {
  at.strokeStyle = style;
  at.beginPath();
  points.forEach(([x, y], k) => k ? at.lineTo(x, y) : at.moveTo(x, y));
  at.stroke();
}
