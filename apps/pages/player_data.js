// From the page's own data to frames: apps/figures/player_pack.py says what is where.

async function inflated(text) {
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it has no DecompressionStream");
  const letters = atob(text.trim()), packed = new Uint8Array(letters.length);
  for (let k = 0; k < packed.length; k++) packed[k] = letters.charCodeAt(k);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The arrays by name.
function arraysOf(list, bytes) {
  const types = { Int8: Int8Array, Int16: Int16Array, Int32: Int32Array, Float32: Float32Array }, found = {};
  let from = 0;
  for (const [name, type, length] of list) {
    found[name] = new types[type](length);
    const size = types[type].BYTES_PER_ELEMENT, own = new Uint8Array(found[name].buffer);
    for (let k = 0; k < own.length; k++) own[k] = bytes[from + (k % size) * length + Math.floor(k / size)];
    from += own.length;
  }
  if (from !== bytes.length) throw new Error("the data of this page are cut");
  return found;
}

// Every frame with an entry for each grain that is in any: places in quanta, levels of speed and spin, contacts, walls.
function framesOf(content, arrays) {
  const count = content.count, pairs = pairsOf(content, arrays), there = arrays.there || new Int8Array(arrays.x.length).fill(1), at = {};
  for (const name of ["x", "z"]) {
    at[name] = Int32Array.from(arrays[name]);
    for (let k = count; k < at[name].length; k++) at[name][k] += at[name][k - count];
  }
  let from = 0;
  return content.number.map((_, f) => {
    const of = values => values && values.subarray(f * count, (f + 1) * count), to = from + content.wall_contacts[f];
    const frame = { there: of(there), x: of(at.x), z: of(at.z), speed: of(arrays.speed), spin: of(arrays.spin), ...pairs[f],
      wallGrain: arrays.wall_grain.subarray(from, to), wallLevel: arrays.wall_force.subarray(from, to), wallAngle: arrays.wall_angle.subarray(from, to),
      walls: content.walls.frames[f].map(state => content.walls.states[state]) };
    from = to;
    return frame;
  });
}

// Contacts between grains, frame by frame: a contact lasts for some of them.
function pairsOf(content, arrays) {
  const { pair_a, pair_b, pair_from, pair_frames, pair_force } = arrays, frames = content.number.map(() => ({ a: [], b: [], level: [] }));
  for (let k = 0, next = 0; k < pair_a.length; k++)
    for (let f = pair_from[k]; f < pair_from[k] + pair_frames[k]; f++) {
      frames[f].a.push(pair_a[k]);
      frames[f].b.push(pair_b[k]);
      frames[f].level.push(pair_force[next++]);
    }
  return frames;
}

// What the page shows, in the units of the run: d, sqrt(d/g), rho0 g d.
class Run {
  constructor(content, arrays) {
    this.content = content;
    this.frames = framesOf(content, arrays);
    this.radius = arrays.radius;
    this.id = Float64Array.from(arrays.id);
    this.kept = new Map();
  }
  static async of(content, text) { return new Run(content, arraysOf(content.arrays, await inflated(text))); }
  x(frame, grain) { return this.content.origin[0] + this.content.quantum * frame.x[grain]; }
  z(frame, grain) { return this.content.origin[1] + this.content.quantum * frame.z[grain]; }
  force(level) { return Math.sign(level) * this.content.mean_force * (level / this.content.force_steps) ** 2; }
  // Values of a field for all grains of a frame; those that are added up of contacts are kept.
  values(name, f) {
    const content = this.content, frame = this.frames[f], count = content.count;
    if (name === "speed") return Float64Array.from(frame.speed, level => content.speed.low * Math.exp(content.speed.step * level));
    if (name === "spin") return Float64Array.from(frame.spin, level => content.spin.quantum * level);
    if (name === "size") return this.radius.map(r => 2 * r);
    if (name === "id") return this.id;
    if (name === "material") return Float64Array.from(content.material);
    const key = name + f;
    if (this.kept.has(key)) return this.kept.get(key);
    const sum = new Float32Array(count);
    const add = (grain, level) => { sum[grain] += name === "coordination" ? 1 : this.force(level) / (2 * Math.PI * this.radius[grain]); };
    for (let k = 0; k < frame.a.length; k++) { add(frame.a[k], frame.level[k]); add(frame.b[k], frame.level[k]); }
    for (let k = 0; k < frame.wallGrain.length; k++) add(frame.wallGrain[k], frame.wallLevel[k]);
    this.kept.set(key, sum);
    return sum;
  }
  // The way from a grain to the nearest image of another, in a domain with a period.
  way(frame, a, b) {
    let x = this.content.quantum * (frame.x[b] - frame.x[a]), z = this.content.quantum * (frame.z[b] - frame.z[a]);
    const cell = frame.walls.find(wall => wall.shape === "cell"), period = this.content.period || (cell && cell.x);
    if (cell) {
      const rows = Math.round(z / (cell.z[1] - cell.z[0]));
      z -= rows * (cell.z[1] - cell.z[0]);
      x -= rows * cell.offset;
    }
    if (period) x -= (period[1] - period[0]) * Math.round(x / (period[1] - period[0]));
    return [x, z];
  }
}
