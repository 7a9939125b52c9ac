// What the page holds: the scene, its arrays and its frames.
const THREE = MeshCat.THREE;
const find = (id) => document.getElementById(id);
const scene = JSON.parse(find("scene").textContent);
const packed = atob(find("data").textContent);
const bytes = new Uint8Array(packed.length);
for (let i = 0; i < packed.length; i++) bytes[i] = packed.charCodeAt(i);
const views = { f4: Float32Array, u4: Uint32Array, u2: Uint16Array };
const array = (at) => new views[at.kind](bytes.buffer, at.offset, at.count);
const times = array(scene.times);
const duration = times[times.length - 1];
const low = new THREE.Vector3(...scene.room.low);
const high = new THREE.Vector3(...scene.room.high);
const centre = low.clone().add(high).multiplyScalar(0.5);
const radius = Math.max(0.5 * low.distanceTo(high), 0.05);
const AIR = 0xe8ecf0;
const beforeRender = []; // functions of the time [s] shown

// The two stored frames around a time, and how far it is from one to the other.
function between(time) {
  const next = Math.min(countUntil(times, time), times.length - 1);
  const last = Math.max(next - 1, 0);
  const span = times[next] - times[last] || 1;
  return { last, next, share: Math.min((time - times[last]) / span, 1) };
}
function countUntil(sorted, value) {
  let a = 0, b = sorted.length;
  while (a < b) {
    const middle = (a + b) >> 1;
    if (sorted[middle] <= value) a = middle + 1; else b = middle;
  }
  return a;
}
