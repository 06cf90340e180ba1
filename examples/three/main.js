/** Builds voxels of a geometry of three.js. Left: three.js shows them as a mesh. Right: the viewer of voxdag shows them. */
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Hands, build, createViewer } from 'voxdag';

const status = document.getElementById('status'), place = document.getElementById('three');

/** Builds a knot whose colours follow its normals. */
async function buildKnot() {
  const { attributes, index } = new THREE.TorusKnotGeometry(1, 0.35, 128, 24);
  const colors = attributes.normal.array.map((x) => 0.5 + 0.5 * x);
  return build({ positions: attributes.position.array, indices: index.array, colors }, {
    resolution: 64, onProgress: (part) => { status.textContent = `Building… ${Math.round(100 * part)}%`; },
  });
}

/** Shows the scene as a mesh: the faces of its voxels, in world units. */
async function showInThree(scene) {
  const renderer = new THREE.WebGLRenderer({ antialias: true }), world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, place.clientWidth / place.clientHeight, 0.1, 100);
  camera.position.set(0, 0, 5.5);
  renderer.setSize(place.clientWidth, place.clientHeight);
  place.append(renderer.domElement);
  world.background = new THREE.Color('#d8e4f0');
  world.add(new THREE.HemisphereLight('#ffffff', '#807060', 3));
  const glb = await scene.save('glb'), { scene: voxels } = await new GLTFLoader().parseAsync(glb.buffer, '');
  world.add(voxels);
  new OrbitControls(camera, renderer.domElement).addEventListener('change', () => renderer.render(world, camera));
  renderer.render(world, camera);

  // Rays need no triangles: the scene casts them at its DAG.
  const raycaster = new THREE.Raycaster();
  place.addEventListener('pointermove', ({ offsetX, offsetY }) => {
    raycaster.setFromCamera(new THREE.Vector2(2 * offsetX / place.clientWidth - 1, 1 - 2 * offsetY / place.clientHeight), camera);
    const { origin, direction } = raycaster.ray, hit = scene.cast(origin.toArray(), direction.toArray());
    status.textContent = hit ? `Voxel ${hit.voxel.join(', ')}` : 'No voxel';
  });
  return renderer.info.render.triangles;
}

async function main() {
  const scene = await buildKnot(), triangles = await showInThree(scene);
  const viewer = createViewer({ container: document.getElementById('viewer'), bytes: scene.bytes });
  new Hands(viewer);
  await viewer.whenStill();
  status.textContent = `${scene.info.voxels.toLocaleString('en')} voxels, ${triangles.toLocaleString('en')} triangles`;
}
main().catch((error) => { status.textContent = error.message; });
