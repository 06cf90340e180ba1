/** Builds scenes of meshes and of files. */
import { buildArguments } from './page/build/build_arguments.js';
import { unpacked } from './page/build/gather_files.js';
import { kindOf, mainFile } from './page/build/input_kinds.js';
import { plyOf } from './ply.js';
import { inputOf, run } from './run.js';
import { open } from './scene.js';

/** @type {typeof import('./index.js').build} */
export async function build(input, { resolution, colors = true, solid = false, args = [], ...job } = {}) {
  const given = 'positions' in input ? [{ name: 'mesh.ply', data: plyOf(input) }] : [input].flat();
  const model = await unpacked(given.map(inputOf)), found = mainFile(model), kind = found && (await kindOf(found.main));
  if (!kind) throw new Error(`no mesh, points, voxels or volume in ${model.map(({ name }) => name).join(', ') || 'no files'}`);
  const { main, others } = found, line = [...buildArguments({ main, kind }, { resolution, colors, solid }), ...args];
  const { files, warnings } = await run(line, model, job), scene = await open(files[0].bytes, job);
  if (others > 0) warnings.unshift(`${main.name}: the largest of ${others + 1}`);
  return Object.assign(scene, { warnings });
}
