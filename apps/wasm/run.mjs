/**
 * Runs the module as a command line under Node: `node run.mjs build mesh.obj -r 512 -o mesh.vdag`.
 * VOXDAG_MODULE names the folder of voxdag.js (default: that of this file). --threads says how many threads start, at most
 * 64; by default one for each processor.
 */
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = path.resolve(process.env.VOXDAG_MODULE ?? path.dirname(fileURLToPath(import.meta.url)));
delete globalThis.fetch;  // the module would load its file from the web
const makeModule = createRequire(import.meta.url)(path.join(folder, 'voxdag.js'));
const args = process.argv.slice(2), option = args.findIndex((text) => /^--threads\b/.test(text));
const threads = Math.min((option >= 0 && Number(args[option].split('=')[1] ?? args[option + 1])) || os.cpus().length, 64);
const module = await makeModule({ print: console.log, printErr: console.error, threads });
// The module sees the files of the machine below /host.
module.FS.mkdir('/host');
module.FS.mount(module.FS.filesystems.NODEFS, { root: '/' }, '/host');
module.FS.chdir(`/host${process.cwd()}`);
const status = module.callMain(args.map((text) => (path.isAbsolute(text) ? `/host${text}` : text)));
process.exit(status);  // the threads wait for more work
