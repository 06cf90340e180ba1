/** Where a brush is that meets no surface: on the floor of the grid. */
import { addScaled } from '../math.js';

/** @typedef {import('../math.js').Vec3} Vec3 */

/**
 * Returns where a ray meets the side of the grid that is below; null if it passes beside it. A scene without
 * voxels is begun there.
 * @param {Pick<import('../viewer_types.js').SceneInfo, 'origin' | 'voxelSize' | 'resolution' | 'levels' | 'view'>} info
 * @param {Vec3} from @param {Vec3} direction @returns {import('../viewer_types.js').Hit | null}
 */
export function floorHit({ origin, voxelSize, resolution, levels, view: { up } }, from, direction) {
  const axis = up.reduce((most, x, a) => (Math.abs(x) > Math.abs(up[most]) ? a : most), 0), isUpper = up[axis] > 0;
  const height = origin[axis] + (isUpper ? 0 : voxelSize * resolution), distance = (height - from[axis]) / direction[axis];
  if (!(distance > 0 && distance < Infinity)) return null;
  const position = addScaled(from, direction, distance);
  position[axis] = height;
  const voxel = /** @type {Vec3} */ (position.map((x, a) => (a === axis ? (isUpper ? 0 : resolution - 1) : Math.floor((x - origin[a]) / voxelSize))));
  return voxel.every((x) => x >= 0 && x < resolution) ? { voxel, level: levels, face: 2 * axis + Number(isUpper), position, distance } : null;
}
