// Surroundings: neutral air, one sun with shadows, a floor grid.
const cell = [0.05, 0.1, 0.25, 0.5, 1, 2.5, 5].find((x) => x > radius / 6) || 10;
function grid() { // short pieces: some renderers drop a line that passes the camera
  const count = Math.ceil((10 * radius) / cell);
  const ends = [];
  for (let i = -count; i <= count; i++)
    for (let k = -count; k < count; k += 2) {
      const from = k * cell, to = Math.min(k + 2, count) * cell;
      ends.push(i * cell, from, 0, i * cell, to, 0, from, i * cell, 0, to, i * cell, 0);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(ends, 3));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({
    color: 0x000000, transparent: true, opacity: 0.13, depthWrite: false }));
  lines.position.z = 0.001 * radius; // clear of the floor
  return lines;
}
function surround() {
  for (const [path, key, value] of [
    [["Lights"], "visible", false], [["Grid"], "visible", false],
    [["Axes"], "visible", false]]) viewer.set_property(path, key, value);
  const air = new THREE.Color(AIR);
  for (const edge of ["top_color", "bottom_color"])
    viewer.set_property(["Background"], edge, air.toArray());
  const sky = new THREE.HemisphereLight(0xffffff, 0xc4beb6, 0.74);
  sky.position.set(0, 0, 1);
  viewer.set_object(["Daylight", "sky"], sky);
  const sun = new THREE.DirectionalLight(0xffffff, 0.44);
  sun.position.copy(centre).add(new THREE.Vector3(0.9, -0.7, 1.8).multiplyScalar(2 * radius));
  sun.target.position.copy(centre).sub(sun.position);
  sun.add(sun.target);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  const reach = 1.3 * radius;
  Object.assign(sun.shadow.camera, { left: -reach, right: reach, top: reach,
    bottom: -reach, near: 0.1 * radius, far: 8 * radius });
  sun.shadow.bias = -0.0008;
  sun.shadow.normalBias = 0.004 * radius;
  viewer.set_object(["Daylight", "sun"], sun);
  const distance = new THREE.Vector3(...scene.view.position)
    .distanceTo(new THREE.Vector3(...scene.view.target));
  viewer.scene.fog = new THREE.Fog(AIR, distance + 2 * radius, distance + 11 * radius);
  const hasFloor = scene.geoms.some((g) => g.kind === "plane" && !g.size[0]);
  if (!hasFloor) {
    const lines = grid();
    lines.position.set(centre.x, centre.y, low.z - 0.001 * radius);
    viewer.set_object(["Floor grid"], lines);
  }
  find("grid").textContent = `grid ${cell} m`;
}
function look() {
  const upright = ([x, y, z]) => [x, z, -y]; // the camera's axes have y upward
  const camera = viewer.camera;
  camera.fov = scene.view.angle;
  camera.near = 0.01 * radius;
  camera.far = 60 * radius;
  camera.position.fromArray(upright(scene.view.position));
  viewer.controls.target.fromArray(upright(scene.view.target));
}
