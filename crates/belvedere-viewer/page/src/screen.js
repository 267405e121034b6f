// From colours and depths of points to the picture: holes between points are closed, what is near is smoothed,
// answers become layers, edges are shaded, the sky painted.
import { BufferAttribute, BufferGeometry, Color, GLSL3, Matrix4, Mesh, NearestFilter, OrthographicCamera, RawShaderMaterial, Vector2, Vector3, WebGLRenderTarget } from "three";
import { FILL, SCREEN_VERTEX, SHADE, SMOOTH } from "./shaders.js";

// Distances to the pixels around one from which holes are closed, wide ones first. Those up to the second number are
// as wide as pixels, whatever lies there.
const [REACHES, FREE] = [[24, 12, 6, 3, 2, 1], 3];
// Places of a picture whose answers make that of one, and how many pixels they lie around it at least.
const [TAPS, LEAST] = [28, 3];
const SKIES = {
  light: { zenith: "#9fc3e6", horizon: "#eaf1f7", below: "#dfe4e8" },
  dark: { zenith: "#0a1018", horizon: "#2b3644", below: "#151a20" },
};
export const uniforms = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));
export const target = () => new WebGLRenderTarget(1, 1, { count: 2, magFilter: NearestFilter, minFilter: NearestFilter });

export class Screen {
  constructor(renderer) {
    this.renderer = renderer;
    this.filled = [0, 1].map(() => Object.assign(target(), { depthBuffer: false }));
    const pass = (fragmentShader, values) => {
      const own = { glslVersion: GLSL3, depthTest: false, depthWrite: false, vertexShader: SCREEN_VERTEX, fragmentShader, uniforms: uniforms({ shown: null, far24: null, far: 1000, ...values }) };
      return new RawShaderMaterial(own);
    };
    this.smooth = pass(SMOOTH, { table: null, reach: 1, pixels: 1, least: 1, kinds: false, taps: 0 });
    this.fill = pass(FILL, { gap: 1, widest: 1, pixels: 1, reach: 1, free: 1 });
    this.shade = pass(SHADE, {
      texel: new Vector2(), slopes: new Vector2(), zenith: new Color(), horizon: new Color(), below: new Color(), sun: new Vector3(), turned: new Matrix4(), strength: 8, ratio: 1, glow: 0, rings: 2,
    });
    const triangle = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.mesh = new Mesh(triangle, this.shade);
    this.mesh.frustumCulled = false;
    this.camera = new OrthographicCamera();
  }

  resize(width, height) {
    this.filled.forEach((one) => one.setSize(width, height));
    this.shade.uniforms.texel.value.set(1 / width, 1 / height);
  }

  pass(material, from, to) {
    [material.uniforms.shown.value, material.uniforms.far24.value] = from.textures;
    this.mesh.material = material;
    this.renderer.setRenderTarget(to);
    this.renderer.render(this.mesh, this.camera);
    return to;
  }

  // Shows what a target holds under the sky of a theme, smooth, and answers as a layer if there are any. What lies
  // `gap` metres behind its surroundings is a hole; a rough picture is neither smooth nor without holes.
  show(from, camera, { theme, gap, widest, pixels, sun, glow, isRough, smooth, isLayer }) {
    const { shade, fill } = this;
    const ratio = this.renderer.getPixelRatio();
    for (const [name, value] of Object.entries({ gap, widest, pixels, free: FREE * ratio })) fill.uniforms[name].value = value;
    fill.uniforms.far.value = shade.uniforms.far.value = camera.far;
    let last = from;
    (isRough ? [] : REACHES).forEach((reach, i) => {
      fill.uniforms.reach.value = Math.max(Math.round(reach * ratio), 1);
      last = this.pass(fill, last, this.filled[i % 2]);
    });
    if (isLayer || !isRough) {
      for (const [name, value] of Object.entries({ ...smooth, pixels, far: camera.far, least: LEAST * ratio, taps: isRough ? 0 : TAPS })) this.smooth.uniforms[name].value = value;
      last = this.pass(this.smooth, last, this.filled[last === this.filled[0] ? 1 : 0]);
    }
    for (const [name, color] of Object.entries(SKIES[theme])) shade.uniforms[name].value.setStyle(color, "");
    const slope = Math.tan((camera.fov * Math.PI) / 360);
    shade.uniforms.slopes.value.set(slope * camera.aspect, slope);
    shade.uniforms.turned.value.copy(camera.matrixWorld);
    shade.uniforms.sun.value.copy(sun);
    shade.uniforms.glow.value = glow;
    shade.uniforms.ratio.value = ratio;
    shade.uniforms.rings.value = isRough ? 1 : 2;
    this.pass(shade, last, null);
  }
}
