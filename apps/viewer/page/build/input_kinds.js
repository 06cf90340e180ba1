/** Which files the program builds scenes of: see docs/meshes.md and docs/import.md. */

/** @typedef {{name: string, data: Blob}} NamedFile */
/** The command that takes a file, and what its grid comes from: its voxels, or a resolution that a person chooses. */
/** @typedef {'mesh' | 'points' | 'voxels' | 'volume'} Kind */

const MESHES = /\.(obj|ply|stl|off|glb|gltf|3mf|dae|fbx)(\.gz|\.zst)?$/i, VOXELS = /\.(vox|binvox|schem|schematic|litematic|nbt|bt|ot)(\.gz|\.zst)?$/i;
const VOLUMES = /\.(npy|nrrd|nhdr|nii|vdb)(\.gz|\.zst)?$/i, POINTS = /\.(las|pcd|xyz|xyzrgb|txt|csv|asc|pts)(\.gz|\.zst)?$/i;

/** Returns which kind of input a name stands for; null: none. @param {string} name @returns {Kind | null} */
export function kindOfName(name) {
  const found = /** @type {[RegExp, Kind][]} */ ([[MESHES, 'mesh'], [VOXELS, 'voxels'], [VOLUMES, 'volume'], [POINTS, 'points']]).find(([names]) => names.test(name));
  return found?.[1] ?? null;
}

/** Returns the kind of a file: a .ply without faces has points, an .npy of rows with three numbers too. @param {NamedFile} file @returns {Promise<Kind | null>} */
export async function kindOf({ name, data }) {
  const kind = kindOfName(name);
  if (/\.ply$/i.test(name)) {
    const head = await data.slice(0, 1 << 14).text(), faces = /element\s+(?:face|tristrips)\s+(\d+)/.exec(head);
    return faces !== null && Number(faces[1]) > 0 ? 'mesh' : 'points';
  }
  if (/\.npy$/i.test(name)) {
    const head = await data.slice(0, 1 << 10).text(), shape = /'shape': \((\d+, *\d+, *\d+),?\)/.exec(head);
    if (shape === null) return /'descr': '[<>|=]?[iu]/.test(head) ? 'voxels' : 'points';
  }
  return kind;
}

/**
 * Chooses the file to build of several: the largest mesh; without meshes the largest file of voxels, else a volume, else points.
 * @param {NamedFile[]} files @returns {{main: NamedFile, others: number} | null}  `others`: files of the same kind beside it; null if there is none to build.
 */
export function mainFile(files) {
  for (const kind of ['mesh', 'voxels', 'volume', 'points']) {
    const found = files.filter(({ name }) => kindOfName(name) === kind).sort((a, b) => b.data.size - a.data.size);
    if (found.length > 0) return { main: found[0], others: found.length - 1 };
  }
  return null;
}
