// Builds the scene in meshcat's viewer, loads its animation last, and runs the bar.
(() => {
  "use strict";
  const THREE = MeshCat.THREE;
  const find = (id) => document.getElementById(id);
  const scene = JSON.parse(find("scene").textContent);
  const bytes = Uint8Array.from(atob(find("data").textContent), (c) => c.charCodeAt(0));
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
      const next = Math.min(countUntil(times, time), times.length - 1);
      const last = Math.max(next - 1, 0);
      const span = times[next] - times[last] || 1;
      const share = Math.min((time - times[last]) / span, 1);
      for (let i = 0; i < size; i++) {
        const a = stored[last * size + i], b = stored[next * size + i];
        vertices[i] = soft.low[i % 3] + soft.step[i % 3] * (a + share * (b - a));
      }
      mesh.geometry.attributes.position.needsUpdate = true;
    });
  }

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
  function addTrace(trace) {
    const flatPoints = array(trace.points);
    const points = [];
    for (let i = 0; i < flatPoints.length; i += 3)
      points.push(new THREE.Vector3().fromArray(flatPoints, i));
    if (points.length === 1) points.push(points[0].clone().add({ x: 1e-4, y: 0, z: 0 }));
    const sides = 6;
    const tube = new THREE.TubeGeometry(new Polyline(points), points.length - 1,
      trace.width / 2, sides);
    const paint = new THREE.MeshBasicMaterial({ color: trace.colour });
    const mesh = new THREE.Mesh(tube, paint);
    viewer.set_object(["Traces", trace.name], mesh);
    if (!trace.times) return;
    const stamps = array(trace.times);
    beforeRender.push((time) => {
      const rings = Math.max(countUntil(stamps, time) - 1, 0);
      tube.setDrawRange(0, rings * sides * 6);
    });
  }
  function countUntil(sorted, value) {
    let a = 0, b = sorted.length;
    while (a < b) {
      const middle = (a + b) >> 1;
      if (sorted[middle] <= value) a = middle + 1; else b = middle;
    }
    return a;
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

  function controls() {
    const animator = viewer.animator;
    const signs = { Pause: "M1 0h3.6v12H1zM7.4 0H11v12H7.4z", Play: "M1 0l10.5 6L1 12z" };
    const slider = find("time"), clock = find("clock"), speed = find("speed");
    const button = find("play");
    slider.max = duration;
    slider.addEventListener("input", () => {
      animator.pause();
      animator.seek(Number(slider.value));
      animator.display_progress(Number(slider.value));
    });
    button.addEventListener("click", () =>
      animator.playing ? animator.pause() : animator.play());
    speed.addEventListener("change", () => {
      animator.mixer.timeScale = Number(speed.value);
    });
    const show = () => {
      requestAnimationFrame(show);
      const text = `${animator.time.toFixed(2)} / ${duration.toFixed(2)} s`;
      if (clock.value !== text) clock.value = text;
      if (document.activeElement !== slider || animator.playing)
        slider.value = animator.time;
      const next = animator.playing ? "Pause" : "Play";
      if (button.dataset.sign === next) return;
      button.dataset.sign = next;
      button.setAttribute("aria-label", next);
      find("sign").setAttribute("d", signs[next]);
    };
    show();
  }

  let viewer;
  try {
    viewer = new MeshCat.Viewer(find("pane"));
  } catch (error) {
    find("pane").innerHTML = '<p id="failure">No replay: this browser has no WebGL.</p>';
    return;
  }
  surround();
  scene.bodies.forEach((body, index) => place(bodyPath(index), {
    position: body.position, quaternion: body.quaternion }));
  scene.geoms.forEach(addGeom);
  scene.soft.forEach(addSoft);
  scene.traces.forEach(addTrace);
  scene.markers.forEach(addMarker);
  look();
  const render = viewer.render.bind(viewer);
  viewer.render = () => {
    for (const update of beforeRender) update(viewer.animator.time);
    render();
  };
  clips.push({ path: ["Clock"], clip: { name: "clock", fps: 1, tracks: [{
    name: ".position", type: "vector3", times: [0, duration], values: [0, 0, 0, 0, 0, 0] }] } });
  viewer.set_animation(clips, { play: true, repetitions: Infinity });
  controls();
})();
