/** The panel "Statistics": the file, the scene, and the work of a frame. */
import { group } from './controls.js';
import { h, say } from './dom.js';
import { bytesText, countText, lengthText } from './numbers.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../viewer_types.js').SceneInfo} SceneInfo
 * @typedef {import('../viewer_types.js').Statistics} Statistics
 */

/** @param {Ui} ui */
export function statisticsPanel(ui) {
  const { viewer } = ui;
  /** @type {(() => void)[]} */
  const refreshers = [];
  /** @param {[string, (info: SceneInfo, s: Statistics) => string | null][]} rows  A null hides the row. */
  const table = (rows) => h('dl', {}, ...rows.map(([name, value]) => {
    const term = h('dt', {}, name), cell = h('dd');
    refreshers.push(() => {
      const text = viewer.info ? value(viewer.info, viewer.statistics()) : '–';
      term.hidden = cell.hidden = text === null;
      say(cell, text ?? '');
    });
    return h('div', {}, term, cell);
  }));
  const number = (/** @type {number} */ x, digits = 3) => (Number.isFinite(x) ? String(+x.toPrecision(digits)) : '–');
  const nodes = (/** @type {number[]} */ counts) => counts.reduce((sum, count) => sum + count, 0);
  const bars = h('div', { class: 'bars', role: 'img' });
  refreshers.push(() => {
    const counts = viewer.info?.dagNodesPerLevel ?? [], most = Math.log(Math.max(2, ...counts) + 1), { levelsLoaded } = viewer.statistics();
    while (bars.children.length < counts.length) bars.append(h('span', {}, h('i', {})));
    counts.forEach((count, level) => {
      const bar = /** @type {HTMLElement} */ (bars.children[level]);
      bar.title = `Level ${level}: ${countText(count)} nodes`;
      bar.classList.toggle('loaded', level < levelsLoaded);
      /** @type {HTMLElement} */ (bar.firstChild).style.height = `${Math.max(4, 100 * Math.log(count + 1) / most)}%`;
    });
    bars.setAttribute('aria-label', `Nodes per level: ${counts.map(countText).join(', ')}`);
  });
  return {
    element: h('div', {},
      group('File', table([
        ['Name', (info) => info.source?.name || info.name || null],
        ['Size', (info) => bytesText(info.fileBytes)],
        ['Triangles of the mesh', (info) => (info.source?.triangles ? countText(info.source.triangles) : null)],
        ['Resolution', (info) => `${countText(info.resolution)}³`],
        ['Size of a voxel', (info) => `${lengthText(info.voxelSize, info.voxelSize * 0.01)} ${info.unit ?? ''}`.trim()],
        ['Voxels', (info) => countText(info.voxels)],
        ['Nodes of the DAG', (info) => countText(nodes(info.dagNodesPerLevel))],
        ['Bits per voxel', (info) => number(info.fileBytes * 8 / info.voxels)],
        ['Attributes', (info) => [info.hasColors && 'colours', info.hasNormals && 'normals', ...info.channels.map(({ name }) => name)].filter(Boolean).join(', ') || 'none'],
      ])),
      group('Nodes per level', bars, h('p', { class: 'hint' }, 'The root is on the left. The heights are logarithms of the numbers.')),
      group('Loaded', table([
        ['Levels', (info, s) => `${s.levelsLoaded} of ${info.levels}`],
        ['Levels shown', (info, s) => (s.levelsShown < s.levelsLoaded ? `${s.levelsShown} of ${info.levels}` : null)],
        ['Bytes', (info, s) => `${bytesText(s.bytesLoaded)} of ${bytesText(s.fileBytes || info.fileBytes)}`],
        ['Memory of the GPU', (info, s) => (s.gpuBytes ? bytesText(s.gpuBytes) : null)],
      ])),
      group('Frame', table([
        ['Time', (info, s) => `${number(s.frameMs)} ms`],
        ['Rays', (info, s) => countText(s.raysPerFrame)],
        ['Steps per ray', (info, s) => number(s.stepsPerRay)],
        ['Steps per frame', (info, s) => countText(s.raysPerFrame * s.stepsPerRay)],
        ['Samples per pixel', (info, s) => `${s.samples} of ${s.samplesWanted}`],
        ['Resolution of the picture', (info, s) => `${Math.round(s.scale * 100)}%`],
      ]))),
    refresh() {
      for (const refresh of refreshers) refresh();
    },
    everyFrame: true,
  };
}
