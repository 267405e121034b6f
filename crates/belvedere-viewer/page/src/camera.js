// Ways of moving: around a place, on foot, and through the air.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const EYE = 1.7;
const STEP = 4;
const RADIAN = Math.PI / 180;
// Ways to look at a whole scene, from the south and from above: the first one unless another fills more of the picture.
const WAYS = [35, 50].flatMap((up) => [25, -25, 50, -50, 75, -75].map((aside) => [-Math.sin(aside * RADIAN) * Math.cos(up * RADIAN), -Math.cos(aside * RADIAN) * Math.cos(up * RADIAN), Math.sin(up * RADIAN)]));
const BETTER = 1.05;

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
    this.groundAt = () => null;
    let last = null;
    canvas.addEventListener("pointermove", (event) => {
      if (this.kind === "orbit" || !event.isPrimary || !(event.buttons & 1)) { last = null; return; }
      if (last) this.turn((last[0] - event.clientX) * 0.004, (last[1] - event.clientY) * 0.004);
      last = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointerup", () => { last = null; });
  }

  // Shows all corners of boxes in a part of the picture: left, right, bottom and top as shares of half of it, from -1
  // to 1.
  show(boxes, flat = false, [left, right, bottom, top] = [-1, 1, -1, 1]) {
    const low = [0, 1, 2].map((axis) => boxes.reduce((v, box) => Math.min(v, box[0][axis]), Infinity));
    const high = [0, 1, 2].map((axis) => boxes.reduce((v, box) => Math.max(v, box[1][axis]), -Infinity));
    const size = Math.hypot(...low.map((v, i) => high[i] - v)) || 10;
    this.size = size;
    const corners = boxes.flatMap((box) => [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => [0, 1, 2].map((axis) => box[(corner >> axis) & 1][axis])));
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    const sides = [[left * slope * this.camera.aspect, right * slope * this.camera.aspect], [bottom * slope, top * slope]];
    const from = (way) => {
      this.camera.position.set(...way);
      this.camera.lookAt(0, 0, 0);
      const axes = [0, 1, 2].map((axis) => new Vector3().setComponent(axis, 1).applyQuaternion(this.camera.quaternion));
      // along right, up and back of the camera: the part of the picture is a pyramid whose apex, the camera, goes as
      // near as no corner is outside of one of its four sides
      const bounds = [-Infinity, Infinity, -Infinity, Infinity];
      let nearest = -Infinity;
      const seen = corners.map(([x, y, z]) => axes.map((axis) => x * axis.x + y * axis.y + z * axis.z));
      for (const v of seen) {
        sides.forEach(([least, most], axis) => {
          bounds[2 * axis] = Math.max(bounds[2 * axis], v[axis] + most * v[2]);
          bounds[2 * axis + 1] = Math.min(bounds[2 * axis + 1], v[axis] + least * v[2]);
        });
        nearest = Math.max(nearest, v[2]);
      }
      const back = Math.max(...sides.map(([least, most], axis) => (bounds[2 * axis] - bounds[2 * axis + 1]) / (most - least)), nearest + 0.05 * size);
      const place = sides.map(([least, most], axis) => (bounds[2 * axis] - most * back + bounds[2 * axis + 1] - least * back) / 2);
      const filled = sides.map(([least, most], axis) => {
        const shown = seen.map((v) => (v[axis] - place[axis]) / (back - v[2]));
        return (shown.reduce((a, b) => Math.max(a, b)) - shown.reduce((a, b) => Math.min(a, b))) / (most - least);
      });
      return { way, axes, back, place, filled: filled[0] * filled[1] };
    };
    const ways = flat ? [[0, -0.001, 1]] : WAYS;
    const { way, axes, back, place } = ways.map(from).reduce((best, one) => (one.filled > BETTER * best.filled ? one : best));
    this.camera.position.set(...way);
    this.camera.lookAt(0, 0, 0);
    this.camera.position.set(0, 0, 0).addScaledVector(axes[0], place[0]).addScaledVector(axes[1], place[1]).addScaledVector(axes[2], back);
    // turning goes around what the middle of the picture shows
    const middle = new Vector3(...low.map((v, i) => (v + high[i]) / 2));
    this.orbit.target.copy(this.camera.position).addScaledVector(axes[2], middle.dot(axes[2]) - back);
    this.shown = { middle, from: this.camera.position.clone() };
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
      // from the whole scene into its middle, which need not be that of the picture
      const { x, y } = this.shown?.from.equals(this.camera.position) ? this.shown.middle : this.orbit.target;
      const [east, north, ground] = this.groundAt(x, y) ?? [x, y, this.orbit.target.z];
      this.camera.position.set(east, north, ground + EYE);
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
      if (ground) this.camera.position.z = z + (ground[2] + EYE - z) * 0.5;
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
