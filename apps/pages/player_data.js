// From the page's own data to frames: apps/figures/player_pack.py says what is where.

async function inflated(text) {
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it has no DecompressionStream");
  const letters = atob(text.trim()), packed = new Uint8Array(letters.length);
  for (let k = 0; k < packed.length; k++) packed[k] = letters.charCodeAt(k);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The planes by name; each number that one byte does not hold has four in the plane NAME+.
class Planes {
  constructor(bytes, list) {
    this.at = {};
    let from = 0;
    for (const [name, length] of list) {
      this.at[name] = { bytes: bytes.subarray(from, from + length), next: 0 };
      from += length;
    }
    if (from !== bytes.length) throw new Error("the data of this page are cut");
  }
  has(name) { return name in this.at; }
  bytes(name) { return this.at[name].bytes; }
  // A function that gives the numbers of a plane one by one.
  small(name) {
    const bytes = this.bytes(name), large = this.bytes(name + "+");
    let k = 0, l = 0;
    return () => {
      let folded = bytes[k++];
      if (folded === 255) {
        folded = large[l] + 256 * large[l + 1] + 65536 * large[l + 2] + 16777216 * large[l + 3];
        l += 4;
      }
      return folded % 2 ? -(folded + 1) / 2 : folded / 2;
    };
  }
  wide(name) {
    const bytes = this.bytes(name), n = bytes.length / 4;
    let k = 0;
    return () => {
      const value = bytes[k] + 256 * bytes[n + k] + 65536 * bytes[2 * n + k] + 16777216 * bytes[3 * n + k];
      k++;
      return value;
    };
  }
  bit(name) {
    const bytes = this.bytes(name);
    return k => (bytes[k >> 3] >> (k & 7)) & 1;
  }
}

// Every frame with an entry for each grain that is in any: places in quanta, levels of speed and spin, contacts, walls.
function framesOf(content, planes) {
  const count = content.count, frames = [], half = 2 ** (content.turn_bits - 1), whole = 2 ** content.turn_bits;
  const isThere = planes.has("there") ? planes.bit("there") : () => 1, row = Math.ceil(count / 8) * 8;
  const restX = planes.small("x"), restZ = planes.small("z");
  const levels = ["speed", "spin"].filter(name => planes.has(name)).map(name => [name, planes.small(name), content[name].changes]);
  const pairs = pairsOf(content, planes), touched = wallContactsOf(content, planes);
  const walls = JSON.parse(new TextDecoder().decode(planes.bytes("walls")));
  let before = null, goesX = new Int32Array(count), goesZ = new Int32Array(count);
  for (let f = 0; f < content.number.length; f++) {
    const [c, s] = content.turns[f], frame = { there: new Uint8Array(count), x: new Int32Array(count), z: new Int32Array(count) };
    for (let g = 0; g < count; g++) {
      if (!isThere(f * row + g)) { goesX[g] = goesZ[g] = 0; continue; }
      const known = before !== null && before.there[g];
      const x = known ? before.x[g] : 0, z = known ? before.z[g] : 0;
      const toX = Math.floor((c * x + s * z + half) / whole), toZ = Math.floor((c * z - s * x + half) / whole);
      const flows = Math.max(Math.abs(goesX[g]), Math.abs(goesZ[g])) > content.flows, u = flows ? goesX[g] : 0, w = flows ? goesZ[g] : 0;
      frame.there[g] = 1;
      frame.x[g] = toX + Math.floor((c * u + s * w + half) / whole) + restX();
      frame.z[g] = toZ + Math.floor((c * w - s * u + half) / whole) + restZ();
      goesX[g] = known ? frame.x[g] - toX : 0;
      goesZ[g] = known ? frame.z[g] - toZ : 0;
    }
    for (const [name, next, changes] of levels) {
      const level = frame[name] = new Int32Array(count);
      for (let g = 0; g < count; g++)
        if (frame.there[g]) level[g] = next() + (changes && before !== null && before.there[g] ? before[name][g] : 0);
    }
    Object.assign(frame, pairs(f), touched(f));
    frame.walls = walls.frames[f].map(state => walls.states[state]);
    frames.push(before = frame);
  }
  return frames;
}

function pairsOf(content, planes) {
  const firsts = planes.small("pair_a"), second = planes.wide("pair_b"), change = planes.small("pair_force"), stays = planes.bit("pair_kept");
  let bit = 0, a = new Int32Array(0), b = a, level = a;
  return f => {
    const [fresh, all] = content.pairs[f], oldA = a, oldB = b, oldLevel = level;
    const newA = new Int32Array(fresh), newB = new Int32Array(fresh);
    for (let k = 0, at = 0; k < fresh; k++) { newA[k] = at += firsts(); newB[k] = second(); }
    a = new Int32Array(all); b = new Int32Array(all); level = new Int32Array(all);
    let old = 0, fromNew = 0;
    const skipGone = () => { while (old < oldA.length && !stays(bit + old)) old++; };
    skipGone();
    for (let k = 0; k < all; k++) {
      const oldFirst = old < oldA.length && (fromNew >= fresh || oldA[old] < newA[fromNew] || (oldA[old] === newA[fromNew] && oldB[old] < newB[fromNew]));
      if (oldFirst) { a[k] = oldA[old]; b[k] = oldB[old]; level[k] = oldLevel[old] + change(); old++; skipGone(); }
      else { a[k] = newA[fromNew]; b[k] = newB[fromNew++]; level[k] = change(); }
    }
    bit += oldA.length;
    return { a, b, level };
  };
}

function wallContactsOf(content, planes) {
  const next = planes.small("wall_grain"), force = planes.small("wall_force"), angles = planes.bytes("wall_angle");
  let from = 0;
  return f => {
    const n = content.wall_contacts[f], wallGrain = new Int32Array(n), wallLevel = new Int32Array(n), wallAngle = angles.subarray(from, from += n);
    for (let k = 0, at = 0; k < n; k++) { wallGrain[k] = at += next(); wallLevel[k] = force(); }
    return { wallGrain, wallLevel, wallAngle };
  };
}

// What the page shows, in the units of the run: d, sqrt(d/g), rho0 g d.
class Run {
  constructor(content, planes) {
    this.content = content;
    this.frames = framesOf(content, planes);
    this.radius = new Float32Array(planes.bytes("radius").slice().buffer);
    const difference = planes.wide("id");
    let id = 0;
    this.id = Float64Array.from({ length: content.count }, () => id += difference());
    this.kept = new Map();
  }
  static async of(content, text) { return new Run(content, new Planes(await inflated(text), content.planes)); }
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
