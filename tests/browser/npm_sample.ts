/** A program that uses the npm package: npm.test.mjs checks its types. */
import { Hands, build, createViewer, open, run } from 'voxdag';
import type { Hit, Scene, Viewer } from 'voxdag';

const control = new AbortController();
const scene: Scene = await build({ positions: new Float32Array(9), indices: [0, 1, 2] }, { resolution: 64, signal: control.signal, onProgress: (part: number) => part });
const files: Scene = await build([{ name: 'a.obj', data: new Uint8Array() }, { name: 'a.mtl', data: new Blob() }], { colors: false, solid: true, args: ['--normal'] });
const hit: Hit | null = scene.cast([0, 0, 0], [0, 0, 1], 10);
const material: number | null = hit && files.material(hit);
const isSet: boolean = scene.contains([1, 2, 3]);
const glb: ArrayBuffer = (await scene.save('glb', { args: ['--smooth'] })).buffer;
const same: Scene = await open(new Blob([scene.bytes]));
const { out, warnings } = await run(['info', '/in/a.vdag'], [{ name: 'a.vdag', data: scene.bytes }]);
const viewer: Viewer = createViewer({ container: document.body, bytes: same.bytes, settings: { show: 'normal', sun: { angle: 2 } } });
viewer.set({ section: { plane: { point: same.info.bounds.low, normal: [1, 0, 0] } }, camera: same.info.view });
new Hands(viewer, { keyboard: viewer.canvas }).destroy();
const picture: Blob = await viewer.capture({ width: 640, height: 480 });
export { glb, isSet, material, out, picture, warnings };

// @ts-expect-error: a mesh needs positions.
build({ indices: [0, 1, 2] });
// @ts-expect-error: a ray has three numbers.
scene.cast([0, 0], [0, 0, 1]);
// @ts-expect-error: there is no such view.
viewer.set({ show: 'beauty' });
