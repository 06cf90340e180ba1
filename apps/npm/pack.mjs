/**
 * Assembles the npm package in a folder: node pack.mjs PAGE FOLDER. PAGE is build/PRESET/apps/viewer/page of a build with
 * -DVOXDAG_BROWSER_MODULE. `npm pack FOLDER` then makes the tarball.
 */
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const HERE = path.dirname(fileURLToPath(import.meta.url));
const SOURCES = ['index.js', 'node.js', 'build.js', 'ply.js', 'run.js', 'scene.js', 'texts.js', 'viewer.js'], OTHERS = ['index.d.ts', 'README.md', 'LICENCES.txt'];
/** The page's files that become texts in modules. */
const TEXTS = [/^gpu\/shaders\/.*\.glsl$/, /^file\/worker\/.*\.js$/, /^build\/(voxdag\.js|voxdag\.worker\.js|voxdag\.wasm\.gz|program_worker\.js)$/];

/** Returns the files below a folder. @param {string} folder @returns {string[]} */
const filesIn = (folder, below = '') => fs.readdirSync(path.join(folder, below), { withFileTypes: true }).flatMap((entry) =>
  entry.isDirectory() ? filesIn(folder, path.posix.join(below, entry.name)) : [path.posix.join(below, entry.name)]);

/** Returns what a module imports: other modules, and in comments types. @param {string} text @returns {string[]} */
const importsOf = (text) => [...text.matchAll(/(?:from |import\()'(\.{1,2}\/[^']+\.js)'/g)].map(([, name]) => name);

/** Adds a module of the page and all that it imports. @param {string} page @param {string} name @param {Set<string>} found */
function addModules(page, name, found) {
  if (found.has(name)) return;
  found.add(name);
  for (const other of importsOf(fs.readFileSync(path.join(page, name), 'utf8'))) addModules(page, path.posix.join(path.posix.dirname(name), other), found);
}

/** @param {string} page @param {string} folder */
async function assemble(page, folder) {
  if (!fs.existsSync(path.join(page, 'build/voxdag.js'))) throw new Error(`${page} has no program for browsers; configure with -DVOXDAG_BROWSER_MODULE`);
  const write = (/** @type {string} */ name, /** @type {string | Buffer} */ contents) => {
    fs.mkdirSync(path.dirname(path.join(folder, name)), { recursive: true });
    fs.writeFileSync(path.join(folder, name), contents);
  };
  const aboutOf = (/** @type {string} */ where) => JSON.parse(fs.readFileSync(path.join(where, 'package.json'), 'utf8'));
  const { name, ...rest } = aboutOf(HERE), { VERSION } = await import(pathToFileURL(path.resolve(page, 'constants.js')).href);
  if (fs.existsSync(folder) && aboutOf(folder).name !== name) throw new Error(`${folder} holds something else`);
  fs.rmSync(folder, { recursive: true, force: true });
  write('package.json', JSON.stringify({ name, version: VERSION, ...rest }, null, 2) + '\n');
  write('LICENSE', fs.readFileSync(path.join(HERE, '../../LICENSE')));

  /** @type {Set<string>} */
  const modules = new Set();
  for (const source of SOURCES) {
    const text = fs.readFileSync(path.join(HERE, source), 'utf8');
    write(source, text);
    for (const other of importsOf(text)) if (other.startsWith('./page/')) addModules(page, other.slice('./page/'.length), modules);
  }
  for (const other of OTHERS) write(other, fs.readFileSync(path.join(HERE, other)));
  for (const module of modules) write(`page/${module}`, fs.readFileSync(path.join(page, module)));

  /** @type {{[group: string]: {[path: string]: string}}} */
  const groups = {};
  for (const file of filesIn(page)) {
    if (!TEXTS.some((pattern) => pattern.test(file))) continue;
    (groups[file.split('/')[0]] ??= {})[file] = fs.readFileSync(path.join(page, file), file.endsWith('.gz') ? 'base64' : 'utf8');
  }
  for (const [group, texts] of Object.entries(groups)) write(`texts/${group}.js`, `/** Made by apps/npm/pack.mjs. */\nexport default ${JSON.stringify(texts, null, 1)};\n`);
}

const [page, folder] = process.argv.slice(2);
try {
  if (!folder) throw new Error('usage: node pack.mjs PAGE FOLDER');
  await assemble(page, folder);
} catch (error) {
  console.error(`pack.mjs: ${/** @type {Error} */ (error).message}`);
  process.exitCode = 1;
}
