/**
 * The npm package: packed, installed into an empty project, run by Node, bundled by vite, and shown in a browser. VOXDAG_PAGE must have
 * the program for browsers.
 */
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { before, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { readPng, spread } from './pictures.mjs';
import { build, buildColored, folder, serveFolder, voxdag } from './program.mjs';

const HERE = path.dirname(fileURLToPath(import.meta.url)), ROOT = path.join(HERE, '../..'), project = path.join(folder, 'project');
const installed = path.join(project, 'node_modules/voxdag');

/** Runs a program in the project and returns what it prints. @param {string} command @param {...string} args */
const run = (command, ...args) => execFileSync(command, args, { cwd: project, encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

/** @type {{filename: string, size: number, files: {path: string}[]}} */
let tarball;
before(() => {
  fs.mkdirSync(project);
  fs.writeFileSync(path.join(project, 'package.json'), '{ "private": true, "type": "module" }');
  run(process.execPath, path.join(ROOT, 'apps/npm/pack.mjs'), process.env.VOXDAG_PAGE ?? '', '../package');
  [tarball] = JSON.parse(run('npm', 'pack', '../package', '--json'));
  run('npm', 'install', '--offline', '--no-audit', '--no-fund', `./${tarball.filename}`);
});

/** The module, as Node loads it. @returns {Promise<any>} */
const load = () => import(pathToFileURL(path.join(installed, 'node.js')).href);
/** Returns the block of the README in a language. @param {string} language */
const readmeBlock = (language) => new RegExp(`\`\`\`${language}\n([^]*?)\`\`\``).exec(fs.readFileSync(path.join(installed, 'README.md'), 'utf8'))?.[1] ?? '';

/** Checks types. @param {string} name @param {object} options @param {string[]} files */
function check(name, options, files) {
  const config = path.join(project, `tsconfig.${name}.json`);
  fs.writeFileSync(config, JSON.stringify({
    compilerOptions: { strict: true, noEmit: true, target: 'es2022', lib: ['es2022', 'dom', 'dom.iterable', 'dom.asynciterable'], types: [], ...options }, files,
  }));
  const result = spawnSync(path.join(HERE, 'node_modules/.bin/tsc'), ['-p', config], { encoding: 'utf8' });
  assert.equal(result.status, 0, result.stdout);
}

describeInBrowsers('the npm package', (_, browser) => {
  it('is small, and has no more than it needs', () => {
    assert.ok(tarball.size < 2_200_000, `${tarball.size} bytes`);
    const folders = new Set(tarball.files.map((file) => file.path.split('/').slice(0, -1).join('/')));
    assert.deepEqual([...folders].sort(), ['', 'page', 'page/build', 'page/file', 'page/gpu', 'page/hands', 'texts']);
  });

  it('runs the README under Node, and prints what the README says', () => {
    fs.writeFileSync(path.join(project, 'readme.js'), readmeBlock('js'));
    assert.equal(run(process.execPath, 'readme.js'), readmeBlock('text'));
  });

  it('has the types that it says', () => {
    fs.copyFileSync(path.join(HERE, 'npm_sample.ts'), path.join(project, 'sample.ts'));
    check('bundler', { module: 'es2022', moduleResolution: 'bundler' }, ['sample.ts']);
    check('node', { module: 'nodenext', lib: ['es2022'] }, ['sample.ts']);
    const sources = fs.readdirSync(installed).filter((name) => name.endsWith('.js')).map((name) => `../package/${name}`);
    check('sources', { module: 'es2022', moduleResolution: 'bundler', allowJs: true, checkJs: true, types: ['node'], typeRoots: [path.join(HERE, 'node_modules/@types')] }, sources);
  });

  it('makes the files of the native program, and opens them', async () => {
    const { build: make, open: openScene, run: command } = await load();
    buildColored(64);
    const mesh = path.join(folder, 'colored.ply'), native = path.join(folder, 'native.vdag'), data = fs.readFileSync(mesh);
    voxdag('build', mesh, '-r', '128', '--color-if-any', '-o', native, '-q');
    /** @type {number[]} */
    const parts = [];
    const scene = await make({ name: 'colored.ply', data }, { resolution: 128, onProgress: (/** @type {number} */ part) => parts.push(part) });
    assert.deepEqual(Buffer.from(scene.bytes), fs.readFileSync(native));
    assert.ok(scene.info.hasColors && parts.every((part) => part >= 0 && part <= 1));
    const packed = gzipSync(data), nativePacked = path.join(folder, 'packed.vdag');
    fs.writeFileSync(`${mesh}.gz`, packed);
    voxdag('build', `${mesh}.gz`, '-r', '128', '--color-if-any', '-o', nativePacked, '-q');
    assert.deepEqual(Buffer.from((await make({ name: 'colored.ply.gz', data: packed }, { resolution: 128 })).bytes), fs.readFileSync(nativePacked));
    for (const [format, ...args] of [['vox'], ['glb'], ['glb', '--texture'], ['stl'], ['ply'], ['obj', '--manifold'], ['3mf']]) {
      const exported = path.join(folder, `native.${format}`);
      voxdag('export', native, '-o', exported, '-q', ...args);
      assert.deepEqual(Buffer.from(await scene.save(format, { args })), fs.readFileSync(exported), [format, ...args].join(' '));
    }

    const plain = build('sponge', 64), compact = path.join(folder, 'compact.vdag');
    voxdag('convert', plain, '--compact', '-o', compact, '-q');
    const opened = await openScene(fs.readFileSync(compact));
    assert.deepEqual(Buffer.from(opened.bytes), fs.readFileSync(plain));
    const { out } = await command(['info', '/in/a.vdag', '--json'], [{ name: 'a.vdag', data: opened.bytes }]);
    assert.equal(JSON.parse(out).voxels, opened.info.voxels);
    const { low, high } = opened.info.bounds, middle = low.map((/** @type {number} */ x, /** @type {number} */ a) => (x + high[a]) / 2);
    const hit = opened.cast([low[0] - 1, low[1] + 1e-3, low[2] + 1e-3], [1, 0, 0]);
    assert.deepEqual([hit.voxel, hit.level, hit.face], [[0, 0, 0], opened.info.levels, 0]);
    assert.deepEqual([opened.contains(middle), opened.contains(hit.position.map((/** @type {number} */ x) => x + 1e-3))], [false, true]);
  });

  it('builds a model of several files with materials', async () => {
    const { build: make } = await load();
    const obj = 'mtllib m/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl red\nf 1 2 3\nusemtl green\nf 4 5 6\n';
    const scene = await make([{ name: 'a.obj', data: Buffer.from(obj) }, { name: 'm/a.mtl', data: Buffer.from('newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n') }],
      { resolution: 32, args: ['--material-ids'] });
    assert.deepEqual(scene.warnings, []);
    assert.deepEqual([-1, 2].map((z) => scene.info.materials[scene.material(scene.cast([0.2, 0.2, z], [0, 0, z < 0 ? 1 : -1]))]), ['red', 'green']);
  });

  it('says in one line what is wrong, and can be cancelled', async () => {
    const { build: make, open: openScene, run: command, createViewer } = await load();
    const triangle = [0, 0, 0, 1, 0, 0, 0, 1, 0], control = new AbortController();
    for (const [work, message] of /** @type {[() => Promise<any>, RegExp][]} */ ([
      [() => make({ name: 'bad.obj', data: Buffer.from('f 1 2 3\n') }), /^bad\.obj: line 1: [^\n]+$/],
      [() => make({ name: 'notes.doc', data: Buffer.from('text') }), /^no mesh, points, voxels or volume in notes\.doc$/],
      [() => make({ name: '../a.obj', data: Buffer.from('v 1 2 3') }), /^"\.\.\/a\.obj": [^\n]+$/],
      [() => make({ positions: [1, 2] }), /^positions has 2 numbers/],
      [() => make({ positions: triangle }, { resolution: -1 }), /^[^\n]*-1[^\n]*$/],
      [() => openScene(Buffer.from('text')), /^This file is of another kind\. [^\n]+$/],
      [() => openScene(fs.readFileSync(build('sponge', 64)).subarray(0, 300)), /^This file is damaged\. [^\n]+$/],
      [() => command(['render', '/in/a.vdag']), /^[^\n]*render[^\n]*$/],
      [async () => createViewer(), /needs a browser/]]))
      await assert.rejects(work, { name: 'Error', message });
    const work = make({ positions: triangle }, { resolution: 4096, signal: control.signal });
    setTimeout(() => control.abort(), 50);
    await assert.rejects(work, { name: 'AbortError' });
    await assert.rejects(make({ positions: triangle }, { signal: AbortSignal.abort() }), { name: 'AbortError' });
  });

  it('is bundled by vite, and shows voxels in three.js and in the viewer', async () => {
    for (const file of ['index.html', 'main.js']) fs.copyFileSync(path.join(ROOT, 'examples/three', file), path.join(project, file));
    fs.symlinkSync(path.join(HERE, 'node_modules/three'), path.join(project, 'node_modules/three'));
    run(process.execPath, path.join(HERE, 'node_modules/vite/bin/vite.js'), 'build', '--base', './', '--logLevel', 'error');
    const server = await serveFolder(path.join(project, 'dist')), page = await open(browser(), server.url, { width: 480, height: 200, ready: '' });
    await page.waitForFunction('!/^Building/.test(document.querySelector("#status").textContent)');
    assert.match(await page.evaluate('document.querySelector("#status").textContent'), /^[\d,]+ voxels, [\d,]+ triangles$/);
    for (const place of ['#three', '#viewer']) {
      const picture = await /** @type {any} */ (await page.$(place)).screenshot();
      assert.ok(spread(readPng(Buffer.from(picture))) > 10, `${place} shows something`);
    }
    assertNoComplaints(page);
    await page.close();
    server.close();
  });
});
