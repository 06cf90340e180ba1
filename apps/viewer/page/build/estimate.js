/** What a build at another resolution will take, from one that is done. */

/** @typedef {{resolution: number, voxels: number, seconds: number, bytes: number, hasColors: boolean}} Done  `bytes`: memory. */

/** Memory of a page's program: 4 GiB; a part of it is lost between pieces. */
export const MOST_BYTES = 0.8 * 2 ** 32;
/** Bytes and seconds that one more voxel takes, without and with colours: rounded up from builds of a courtyard and of a coloured surface. */
const COST = { bare: { bytes: 0.7, seconds: 3e-8 }, colored: { bytes: 3, seconds: 1.5e-6 } };

/** Returns what a build will take: each doubling sets four times as many voxels of a surface. @param {Done} done @param {number} resolution @param {{colors: boolean, solid: boolean}} options */
export function expected(done, resolution, { colors, solid }) {
  const voxels = done.voxels * (resolution / done.resolution) ** 2, more = Math.max(0, voxels - done.voxels);
  const cost = colors ? COST.colored : COST.bare;
  // How many voxels a body has inside is unknown; without colours they cost little, as a full cell is one node.
  return { voxels: solid ? NaN : voxels, seconds: done.seconds + more * cost.seconds, bytes: done.bytes + more * cost.bytes };
}
