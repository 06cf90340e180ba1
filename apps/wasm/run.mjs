/**
 * Runs the module as a command line under Node: `node run.mjs build mesh.obj -r 512 -o mesh.vdag`.
 * VOXDAG_MODULE names the folder of voxdag.js (default: that of this file).
 */
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = path.resolve(process.env.VOXDAG_MODULE ?? path.dirname(fileURLToPath(import.meta.url)));
delete globalThis.fetch;  // the module would load its file from the web
const makeModule = createRequire(import.meta.url)(path.join(folder, 'voxdag.js'));
const module = await makeModule({ print: console.log, printErr: console.error });
// The module sees the files of the machine below /host.
module.FS.mkdir('/host');
module.FS.mount(module.FS.filesystems.NODEFS, { root: '/' }, '/host');
module.FS.chdir(`/host${process.cwd()}`);
process.exitCode = module.callMain(process.argv.slice(2).map((text) => (path.isAbsolute(text) ? `/host${text}` : text)));
