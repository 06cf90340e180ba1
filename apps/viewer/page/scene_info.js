/** What a scene tells of itself: what its file says, the bounds of its cells, and its first view. */
import { axisNamed, homeView } from './hands/pose.js';
import { bounds } from './trace.js';

/**
 * @typedef {import('./file/scene_loader.js').FileInfo} FileInfo
 * @typedef {import('./viewer_types.js').SceneInfo} SceneInfo
 * @typedef {import('./math.js').Vec3} Vec3
 */

/** The scene's bounds are those of its cells of this level: finer ones would take long to visit. */
const BOUNDS_LEVEL = 9;

/** Returns the bounds of cells in world units; null without cells. @param {import('./trace.js').Dag} dag */
export const boundsOf = (dag) => bounds(dag, BOUNDS_LEVEL);

/**
 * Returns the first view. Its up vector is that of the file, or else `guessed`.
 * @param {import('./hands/pose.js').Box} box @param {FileInfo} file @param {Vec3} guessed @param {number} aspect  Width / height.
 */
export const firstView = (box, { up, home }, guessed, aspect) => homeView(box, aspect, up === null ? guessed : axisNamed(up), home);

/** Returns what is known before cells have arrived: the bounds are those of the grid. @param {FileInfo} file @param {Vec3} guessed @param {number} aspect @param {boolean} isWhole @returns {SceneInfo} */
export function sceneInfo(file, guessed, aspect, isWhole) {
  const { levels, resolution, origin, voxelSize, voxels, dagNodesPerLevel, fileBytes, hasColors, hasNormals, materials, channels, source, home, cubes, unit } = file;
  const side = voxelSize * resolution, box = { low: origin, high: /** @type {Vec3} */ (origin.map((x) => x + side)) };
  return {
    name: source.name, levels, resolution, origin, voxelSize, bounds: box, voxels, dagNodesPerLevel, fileBytes, hasColors, hasNormals, materials, channels, source,
    view: firstView(box, file, guessed, aspect), home, cubes, unit, isWhole,
  };
}
