// Ways of moving: around a place, on foot, and through the air.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const EYE = 1.7;
const STEP = 4;

export class Mover {
  constructor(canvas, changed) {
    this.camera = new PerspectiveCamera(50, 1, 0.1, 5000);
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    Object.assign(this.orbit, { zoomToCursor: true, screenSpacePanning: false, maxPolarAngle: 1.75, enableDamping: false });
    this.orbit.addEventListener("change", changed);
    this.changed = changed;
    this.kind = "orbit";
    this.keys = new Set();
    this.groundAt = () => undefined;
    let last = null;
    canvas.addEventListener("pointermove", (event) => {
      if (this.kind === "orbit" || !event.isPrimary || !(event.buttons & 1)) { last = null; return; }
      if (last) this.turn((last[0] - event.clientX) * 0.004, (last[1] - event.clientY) * 0.004);
      last = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointerup", () => { last = null; });
  }

  // Shows boxes as a whole in the part of the picture, across and upright, that no bar covers.
  show(boxes, flat = false, [across, upright] = [1, 1]) {
    const low = [0, 1, 2].map((axis) => boxes.reduce((v, box) => Math.min(v, box[0][axis]), Infinity));
    const high = [0, 1, 2].map((axis) => boxes.reduce((v, box) => Math.max(v, box[1][axis]), -Infinity));
    const middle = low.map((v, i) => (v + high[i]) / 2);
    const size = Math.hypot(...low.map((v, i) => high[i] - v)) || 10;
    this.size = size;
    const away = new Vector3(...(flat ? [0, -0.001, 1] : [-0.4, -0.62, 0.56])).normalize();
    this.camera.position.set(...middle).add(away);
    this.orbit.target.set(...middle);
    this.camera.lookAt(this.orbit.target);
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    const [right, up, back] = [0, 1, 2].map((axis) => new Vector3().setComponent(axis, 1).applyQuaternion(this.camera.quaternion));
    const corners = boxes.flatMap((box) => [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => new Vector3(...[0, 1, 2].map((axis) => box[(corner >> axis) & 1][axis]))));
    const target = new Vector3(...middle);
    let distance = size;
    // nearer corners look larger: what is shown moves until it lies in the middle of the picture
    for (let i = 0; i < 5; i++) {
      const offsets = corners.map((corner) => corner.clone().sub(target)).map((v) => [v.dot(right), v.dot(up), v.dot(back)]);
      distance = offsets.reduce((d, [x, y, z]) => Math.max(d, Math.abs(x) / (slope * this.camera.aspect * across) + z, Math.abs(y) / (slope * upright) + z), 0.2 * size);
      for (const [axis, direction] of [right, up].entries()) {
        const [least, greatest] = offsets.map((v) => v[axis] / (distance - v[2])).reduce(([l, g], v) => [Math.min(l, v), Math.max(g, v)], [Infinity, -Infinity]);
        const level = direction.clone().setZ(0);
        target.addScaledVector(level, ((least + greatest) / 2) * distance / level.lengthSq());
      }
    }
    this.camera.position.copy(target).addScaledVector(away, distance);
    this.orbit.target.copy(target);
    this.camera.near = Math.max(size / 5000, 0.05);
    this.camera.far = size * 8;
    this.camera.updateProjectionMatrix();
    this.kind = "orbit";
    this.orbit.enabled = true;
    this.camera.lookAt(this.orbit.target);
    this.orbit.update();
    this.changed();
  }

  setKind(kind) {
    this.kind = kind;
    this.orbit.enabled = kind === "orbit";
    const forward = this.camera.getWorldDirection(new Vector3());
    if (kind === "orbit") {
      this.orbit.target.copy(this.camera.position).addScaledVector(forward, Math.max(20, this.camera.position.z));
      this.orbit.update();
    } else if (kind === "walk") {
      const { x, y } = this.orbit.target;
      this.camera.position.set(x, y, (this.groundAt(x, y) ?? this.orbit.target.z) + EYE);
      forward.z = 0;
      this.camera.lookAt(this.camera.position.clone().add(forward.lengthSq() > 1e-6 ? forward : new Vector3(0, 1, 0)));
    }
    this.changed();
  }

  // Turns by angles: around the middle of the scene, or the head.
  turn(aside, up) {
    if (this.kind === "orbit") {
      this.orbit._rotateLeft(-aside);
      this.orbit._rotateUp(-up);
      this.orbit.update();
      return;
    }
    const forward = this.camera.getWorldDirection(new Vector3());
    const azimuth = Math.atan2(forward.y, forward.x) + aside;
    const elevation = Math.max(-1.5, Math.min(1.5, Math.asin(forward.z) + up));
    const look = new Vector3(Math.cos(azimuth) * Math.cos(elevation), Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation));
    this.camera.lookAt(this.camera.position.clone().add(look));
    this.changed();
  }

  zoom(factor) {
    const { position } = this.camera;
    position.sub(this.orbit.target).multiplyScalar(factor).add(this.orbit.target);
    this.orbit.update();
    this.changed();
  }

  // Goes ahead, aside and up by steps.
  go(ahead, aside, up) {
    const forward = this.camera.getWorldDirection(new Vector3());
    if (this.kind !== "fly") forward.setZ(0).normalize();
    const right = new Vector3().crossVectors(forward, this.camera.up).normalize();
    const length = this.kind === "orbit" ? this.size / 60 : STEP / 4;
    const by = forward.multiplyScalar(ahead * length).addScaledVector(right, aside * length).add(new Vector3(0, 0, up * length));
    this.camera.position.add(by);
    if (this.kind === "orbit") this.orbit.target.add(by);
    if (this.kind === "walk") {
      const { x, y, z } = this.camera.position;
      const ground = this.groundAt(x, y);
      if (ground !== undefined) this.camera.position.z = z + (ground + EYE - z) * 0.5;
    }
    if (this.kind === "orbit") this.orbit.update();
    this.changed();
  }

  // Stands at a local place.
  stand([x, y, z]) {
    const forward = this.camera.getWorldDirection(new Vector3()).setZ(0);
    this.camera.position.set(x, y, z);
    this.camera.lookAt(this.camera.position.clone().add(forward));
    this.changed();
  }
}
