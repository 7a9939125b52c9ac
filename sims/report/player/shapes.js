// Shapes, in MuJoCo's conventions: half sizes, axes along z.
function lathe(profile) {
  const points = profile.map(([r, z]) => new THREE.Vector2(r, z));
  return new THREE.LatheGeometry(points, 32).rotateX(Math.PI / 2);
}
function capsule(r, half) {
  const arc = (from, z) => Array.from({ length: 9 }, (_, k) => {
    const a = from + (k * Math.PI) / 16;
    return [Math.max(r * Math.cos(a), 0), z + r * Math.sin(a)];
  });
  return lathe([...arc(-Math.PI / 2, -half), ...arc(0, half)]);
}
function surface(vertices, faces) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
  geometry.setIndex(new THREE.BufferAttribute(faces, 1));
  geometry.computeVertexNormals();
  return geometry;
}
const far = 14 * radius; // half width of planes without end
const shapes = {
  plane: ([x, y]) => new THREE.PlaneGeometry(2 * (x || far), 2 * (y || far)),
  sphere: ([r]) => new THREE.SphereGeometry(r, 32, 20),
  capsule: ([r, half]) => capsule(r, half),
  ellipsoid: ([x, y, z]) => new THREE.SphereGeometry(1, 32, 20).scale(x, y, z),
  cylinder: ([r, half]) =>
    new THREE.CylinderGeometry(r, r, 2 * half, 40).rotateX(Math.PI / 2),
  box: ([x, y, z]) => new THREE.BoxGeometry(2 * x, 2 * y, 2 * z),
  mesh: (_, geom) => surface(array(geom.vertices), array(geom.faces)),
};
function paint([r, g, b, opacity], options) {
  return new THREE.MeshPhongMaterial({
    color: new THREE.Color(r, g, b), opacity, transparent: opacity < 1,
    depthWrite: opacity >= 1, specular: 0x1c1c1c, shininess: 40, ...options,
  });
}
const flat = { flatShading: true, side: THREE.DoubleSide };

function addGeom(geom, index) {
  const isPlane = geom.kind === "plane";
  const options = isPlane ? { polygonOffset: true, polygonOffsetFactor: 2,
    polygonOffsetUnits: 2 } : geom.kind === "mesh" ? flat : {};
  const shape = shapes[geom.kind](geom.size, geom);
  const mesh = new THREE.Mesh(shape, paint(geom.rgba, options));
  mesh.position.fromArray(geom.position);
  mesh.quaternion.fromArray(geom.quaternion);
  mesh.castShadow = !isPlane && geom.rgba[3] >= 1;
  mesh.receiveShadow = true;
  if (isPlane && !geom.size[0]) mesh.add(grid());
  viewer.set_object([...bodyPath(geom.body), `${geom.kind} ${index}`], mesh);
}

// Soft bodies: vertices of two stored frames, blended.
function addSoft(soft) {
  const stored = array(soft.vertices);
  const size = stored.length / times.length;
  const vertices = new Float32Array(size);
  const mesh = new THREE.Mesh(surface(vertices, array(soft.faces)),
    paint(soft.rgba, flat));
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  viewer.set_object(["Scene objects", soft.name], mesh);
  beforeRender.push((time) => {
    const { last, next, share } = between(time);
    for (let i = 0; i < size; i++) {
      const a = stored[last * size + i], b = stored[next * size + i];
      vertices[i] = soft.low[i % 3] + soft.step[i % 3] * (a + share * (b - a));
    }
    mesh.geometry.attributes.position.needsUpdate = true;
  });
}
