// Traces: a tube with one ring a point, so that it can grow point by point.
class Polyline extends THREE.Curve {
  constructor(points) { super(); this.points = points; this.last = points.length - 1; }
  getPoint(u, target = new THREE.Vector3()) {
    return target.copy(this.points[Math.round(u * this.last)]);
  }
  getPointAt(u, target) { return this.getPoint(u, target); }
  getTangentAt(u, target = new THREE.Vector3()) {
    const k = Math.round(u * this.last);
    const next = this.points[Math.min(k + 1, this.last)];
    return target.copy(next).sub(this.points[Math.max(k - 1, 0)]).normalize();
  }
}
const sides = 6;
function tubeThrough(flatPoints, width) {
  const points = [];
  for (let i = 0; i < flatPoints.length; i += 3)
    points.push(new THREE.Vector3().fromArray(flatPoints, i));
  if (points.length === 1) points.push(points[0].clone().add({ x: 1e-4, y: 0, z: 0 }));
  return new THREE.TubeGeometry(new Polyline(points), points.length - 1, width / 2, sides);
}
function addTrace(trace) {
  const paint = new THREE.MeshBasicMaterial({ color: trace.colour });
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), paint);
  viewer.set_object(["Traces", trace.name], mesh);
  if (trace.moving) return bend(mesh, trace);
  const tube = tubeThrough(array(trace.points), trace.width);
  mesh.geometry = tube;
  if (!trace.times) return;
  const stamps = array(trace.times);
  beforeRender.push((time) => {
    const rings = Math.max(countUntil(stamps, time) - 1, 0);
    tube.setDrawRange(0, rings * sides * 6);
  });
}
// A line that moves, seen through what it moves in: its tube anew for every picture.
function bend(mesh, trace) {
  Object.assign(mesh.material, { depthTest: false, transparent: true, opacity: 0.8 });
  const stored = array(trace.moving);
  const size = stored.length / times.length;
  const points = new Float32Array(size);
  mesh.frustumCulled = false;
  beforeRender.push((time) => {
    const { last, next, share } = between(time);
    for (let i = 0; i < size; i++) {
      const a = stored[last * size + i];
      points[i] = a + share * (stored[next * size + i] - a);
    }
    mesh.geometry.dispose();
    mesh.geometry = tubeThrough(points, trace.width);
  });
}

// Motion: one clip a moving node.
const clips = [];
const kinds = { position: "vector3", quaternion: "quaternion" };
function place(path, motions) {
  const node = viewer.scene_tree.find(path).object;
  const tracks = [];
  for (const [property, motion] of Object.entries(motions)) {
    node[property].fromArray(motion.first);
    if (motion.keys) tracks.push({ name: `.${property}`, type: kinds[property],
      times, values: array(motion.keys) });
  }
  if (tracks.length) clips.push({ path, clip: { name: path.join(" "), fps: 1, tracks } });
}
const bodyPath = (index) => ["Bodies", `${index} ${scene.bodies[index].name}`];

function addMarker(marker, index) {
  const path = ["Markers", `${index} ${marker.name}`];
  const ball = new THREE.Mesh(new THREE.SphereGeometry(marker.radius, 24, 16),
    new THREE.MeshPhongMaterial({ color: marker.colour }));
  viewer.set_object([...path, "ball"], ball);
  place(path, { position: marker.position });
}

// Arrows show through all else: a force points into what it pushes.
const sizes = document.querySelectorAll("#legend .size");
function addArrow(arrow, index) {
  const stored = { points: array(arrow.points), vectors: array(arrow.vectors) };
  const thick = 0.006 * radius, tip = 6 * thick, scale = 0.01 / arrow.perCm;
  const paint = new THREE.MeshPhongMaterial({ color: arrow.colour,
    emissive: arrow.colour, emissiveIntensity: 0.35, transparent: true, depthTest: false });
  const upright = (geometry) => new THREE.Mesh(
    geometry.translate(0, 0.5, 0).rotateX(Math.PI / 2), paint);
  const shaft = upright(new THREE.CylinderGeometry(thick, thick, 1, 12));
  const head = upright(new THREE.ConeGeometry(2.4 * thick, 1, 16));
  shaft.renderOrder = head.renderOrder = 10 + index;
  const group = new THREE.Group();
  group.add(shaft, head);
  viewer.set_object(["Arrows", `${index} ${arrow.name}`], group);
  const up = new THREE.Vector3(0, 0, 1), p = new THREE.Vector3(), v = new THREE.Vector3();
  const a = new THREE.Vector3();
  const at = (values, { last, next, share }, out) => out.fromArray(values, 3 * last)
    .lerp(a.fromArray(values, 3 * next), share);
  beforeRender.push((time) => {
    const when = between(time);
    at(stored.points, when, p);
    at(stored.vectors, when, v);
    const size = v.length(), length = size * scale;
    const text = `${size.toFixed(1)} ${arrow.unit}`;
    if (sizes[index].value !== text) sizes[index].value = text;
    group.visible = length > 0.2 * thick;
    if (!group.visible) return;
    v.divideScalar(size);
    group.quaternion.setFromUnitVectors(up, v);
    group.position.copy(p).addScaledVector(v, arrow.ends ? -length : 0);
    const pointed = Math.min(tip, 0.6 * length);
    const slim = Math.min(1, length / (2 * tip)); // small ones thinner, too
    group.scale.set(slim, slim, 1);
    shaft.scale.z = length - pointed;
    head.scale.z = pointed;
    head.position.z = length - pointed;
  });
}
