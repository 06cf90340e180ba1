/** Runs voxdag: builds scenes for the tests, and serves them. */
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

/** The program under test. */
export const VOXDAG = process.env.VOXDAG ?? '';
assert.ok(fs.existsSync(VOXDAG), 'VOXDAG must name the program');

/** A folder for the files of this run. */
export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'voxdag-browser-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));

/** Runs voxdag and returns what it prints. @param {...string} args */
export function voxdag(...args) {
  return execFileSync(VOXDAG, args, { encoding: 'utf8', cwd: folder });
}

/**
 * Builds a procedural scene. Returns the file's path.
 * @param {string} name @param {number} resolution @param {...string} options of `voxdag build`
 */
export function build(name, resolution, ...options) {
  const mesh = path.join(folder, `${name}.ply`), file = path.join(folder, `${name}-${resolution}${options.join('')}.vdag`);
  if (!fs.existsSync(mesh)) voxdag('scene', name, '-o', mesh, '-q');
  if (!fs.existsSync(file)) voxdag('build', mesh, '-r', String(resolution), '-o', file, '-q', ...options);
  return file;
}

/** Writes a mesh whose vertices have colours, and builds a DAG with colours and normals of it. @param {number} resolution */
export function buildColored(resolution) {
  const mesh = path.join(folder, 'colored.ply'), file = path.join(folder, `colored-${resolution}.vdag`);
  const rows = 48;
  const vertices = [], faces = [];
  for (let j = 0; j <= rows; ++j)
    for (let i = 0; i <= rows; ++i) {
      const u = i / rows, v = j / rows, h = 0.25 * Math.sin(9 * u) * Math.cos(7 * v);
      vertices.push(`${u} ${h} ${v} ${Math.round(255 * u)} ${Math.round(255 * v)} ${Math.round(127 + 127 * Math.sin(20 * u * v))}`);
      if (i < rows && j < rows) {
        const at = j * (rows + 1) + i;
        faces.push(`3 ${at} ${at + rows + 1} ${at + 1}`, `3 ${at + 1} ${at + rows + 1} ${at + rows + 2}`);
      }
    }
  fs.writeFileSync(mesh, `ply\nformat ascii 1.0\nelement vertex ${vertices.length}\nproperty float x\nproperty float y\nproperty float z\n` +
      'property uchar red\nproperty uchar green\nproperty uchar blue\n' +
      `element face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n${vertices.join('\n')}\n${faces.join('\n')}\n`);
  voxdag('build', mesh, '-r', String(resolution), '--color', '--normal', '-o', file, '-q');
  return file;
}

/**
 * Serves a scene by `voxdag view`. Returns the address and a function that ends the server.
 * @param {string} file @param {...string} options @returns {Promise<{url: string, close: () => Promise<void>}>}
 */
export async function view(file, ...options) {
  const server = spawn(VOXDAG, ['view', file, '--no-open', '--port', '0', ...options], { cwd: folder });
  let output = '';
  server.stderr.on('data', (text) => (output += text));
  const url = await new Promise((resolve, reject) => {
    server.stdout.on('data', (text) => {
      output += text;
      const address = /http:\/\/\S+/.exec(output);
      if (address !== null) resolve(address[0]);
    });
    server.on('exit', (code) => reject(new Error(`voxdag view ended with ${code}: ${output}`)));
  });
  // A test that fails leaves its server behind: it must not keep this process alive.
  for (const handle of /** @type {any[]} */ ([server, server.stdout, server.stderr])) handle.unref();
  process.on('exit', () => server.kill());
  const close = () => new Promise((resolve) => {
    server.ref();
    server.removeAllListeners('exit');
    server.on('exit', () => resolve(undefined));
    server.kill('SIGINT');
  });
  return { url, close: /** @type {any} */ (close) };
}

/**
 * Serves a folder as a plain web server does, without ranges.
 * @param {string} site @param {{[name: string]: string}} [headers]  Of each answer. @returns {Promise<{url: string, close: () => void}>}
 */
export async function serveFolder(site, headers = {}) {
  const server = http.createServer((request, response) => {
    const name = path.join(site, new URL(request.url ?? '/', 'http://x').pathname.replace(/\/$/, '/index.html'));
    const kinds = { '.js': 'text/javascript', '.html': 'text/html', '.css': 'text/css', '.svg': 'image/svg+xml' };
    if (!fs.existsSync(name)) return response.writeHead(name.endsWith('favicon.ico') ? 204 : 404).end();
    response.writeHead(200, { ...headers, 'Content-Type': kinds[/** @type {'.js'} */ (path.extname(name))] ?? 'application/octet-stream' });
    fs.createReadStream(name).pipe(response);
  });
  return { url: await listen(server), close: () => server.close() };
}

/**
 * Serves another server's pages, and notes each request. May lack Range, or hold back all parts of a file but its first
 * until `release` is called.
 * @param {string} url @param {{hold?: boolean, ranges?: boolean}} [options]
 */
export async function proxy(url, { hold = false, ranges = true } = {}) {
  /** @type {{path: string, range: string}[]} */
  const requests = [];
  let release = () => {};
  const released = hold ? new Promise((resolve) => (release = () => resolve(undefined))) : Promise.resolve();
  const server = http.createServer(async (request, response) => {
    const { url: place = '/', headers: { ...headers } } = request;
    requests.push({ path: place, range: headers.range ?? '' });
    if (!/^(bytes=0-.*)?$/.test(headers.range ?? '')) await released;
    headers.host = new URL(url).host;
    if (!ranges) delete headers.range;
    http.get(new URL(place, url), { headers }, (answer) => {
      const kept = { ...answer.headers };
      if (!ranges) delete kept['accept-ranges'];
      response.writeHead(answer.statusCode ?? 500, kept);
      answer.pipe(response);
    }).on('error', () => response.destroy());
  });
  return { url: await listen(server), requests, release, close: () => server.close() };
}

/** Opens a port. Returns the address. @param {http.Server} server */
async function listen(server) {
  await new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(undefined)));
  server.unref();
  const { port } = /** @type {import('node:net').AddressInfo} */ (server.address());
  return `http://127.0.0.1:${port}/`;
}
