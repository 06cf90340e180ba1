/** The page's files: types, size, and that they need nothing from elsewhere. */
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import zlib from 'node:zlib';

/** A complete copy of the page, made by the build. */
const PAGE = process.env.VOXDAG_PAGE ?? '';

/** The files of the page itself, without those of the program for browsers. */
const files = list('').filter((name) => !/^build.voxdag\./.test(name));

/** Returns the files below a folder of the page. @param {string} folder @returns {string[]} */
function list(folder) {
  return fs.readdirSync(path.join(PAGE, folder), { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? list(path.join(folder, entry.name)) : [path.join(folder, entry.name)]);
}

/** Checks types with tsc. @param {string} name @param {object} options  Of the compiler. @param {string[]} include */
function check(name, options, include) {
  const config = path.join(PAGE, '..', `tsconfig.${name}.json`);
  fs.writeFileSync(config, JSON.stringify({
    compilerOptions: { checkJs: true, allowJs: true, strict: true, noEmit: true, target: 'es2022', module: 'es2022', moduleResolution: 'bundler', types: [], ...options },
    include: include.map((pattern) => path.join(PAGE, pattern)), exclude: name === 'page' ? ['file/worker/*', 'build/voxdag.js', 'build/voxdag.worker.js'].map((pattern) => path.join(PAGE, pattern)) : [],
  }));
  const result = spawnSync(fileURLToPath(new URL('node_modules/.bin/tsc', import.meta.url)), ['-p', config], { encoding: 'utf8' });
  assert.equal(result.status, 0, result.stdout);
}

describe('the page', () => {
  it('has the types that its comments say', () => check('page', { lib: ['es2022', 'dom', 'dom.iterable', 'dom.asynciterable'] }, ['**/*.js']));

  it('has a worker with the types that its comments say', () => {
    const constants = fs.readFileSync(path.join(PAGE, 'constants.js'), 'utf8');
    fs.writeFileSync(path.join(PAGE, '..', 'worker_constants.js'), constants.replace(/^export /gm, '') + '\nconst INSTANCE_STEPS = 4;\n');
    const worker = path.join(PAGE, '..', 'worker_constants.js');
    check('worker', { lib: ['es2022', 'dom'], moduleDetection: 'legacy' },
          ['file/worker/*.js', path.relative(PAGE, worker)]);
  });

  it('has the defaults of `voxdag render`', async () => {
    const load = (/** @type {string} */ name) => import(pathToFileURL(path.join(PAGE, name)).href);
    const { LIGHT, VIEW } = await load('constants.js'), { DEFAULTS, mergeSettings } = await load('settings.js');
    const { sun, sky, occlusion, lod, cubes } = DEFAULTS;
    assert.deepEqual([sun.angle, sky, occlusion.samples, occlusion.cone, lod, cubes],
      [LIGHT.sunDegrees, LIGHT.sky, LIGHT.occlusionSamples, LIGHT.occlusionCone, LIGHT.lodPixels, LIGHT.cubePixels]);
    const { camera } = mergeSettings(DEFAULTS, { camera: { eye: [0, 0, 1], target: [0, 0, 0] } });
    assert.equal(camera.fov, VIEW.fovDegrees);
    assert.doesNotThrow(() => mergeSettings(DEFAULTS, { camera: { ...camera, fov: VIEW.minFovDegrees } }));
  });

  it('takes less than 220 KB, each file compressed', () => {
    const bytes = files.reduce((sum, name) => sum + zlib.gzipSync(fs.readFileSync(path.join(PAGE, name)), { level: 9 }).length, 0);
    assert.ok(bytes < 220_000, `${bytes} bytes`);
  });

  it('loads nothing from other hosts', () => {
    for (const name of files) {
      const text = fs.readFileSync(path.join(PAGE, name), 'utf8').replaceAll('http://www.w3.org/2000/svg', '');
      assert.doesNotMatch(text, /(src|href)="?https?:|import\s*\(?['"]https?:|url\(['"]?https?:|fetch\(['"]https?:/, name);
    }
  });
});
