/** The panel "Build": builds a scene of a model, first a coarse one, then the one that a person chooses. */
import { buildArguments } from '../build/build_arguments.js';
import { MOST_BYTES, expected } from '../build/estimate.js';
import { hasProgram, plainLine, run } from '../build/program.js';
import { button, group, slider, textField, toggle } from './controls.js';
import { h, say } from './dom.js';
import { bytesText, roundText, secondsText } from './numbers.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../build/input_kinds.js').NamedFile} NamedFile
 * @typedef {import('../build/input_kinds.js').Kind} Kind
 * @typedef {{main: NamedFile, kind: Kind, files: NamedFile[]}} Model
 */

const COARSE = 128, LEAST = 256, MOST = 8192;

/** @param {Ui} ui */
export function buildPanel(ui) {
  const { viewer } = ui;
  /** @type {Model | null} */
  let model = null;
  /** The last build of the model. @type {import('../build/estimate.js').Done | null} */
  let done = null;
  let resolution = 1024, colors = true, solid = false, threshold = '';

  /** Whether a person chooses the resolution. */
  const isScaled = () => model?.kind === 'mesh' || model?.kind === 'points';
  /** Builds the model and shows it; the scene before stays until then. @param {Model} of @param {number} side */
  const build = (of, side) => ui.job('Build', async ({ signal, progress }) => {
    const { out, lines, files, bytes } = await run(buildArguments(of, { resolution: side, colors, solid, threshold }), of.files, { signal, onProgress: progress }).catch((error) => {
      if (!signal.aborted && /memory/.test(error.message) && side > LEAST) error.message += `: try a resolution of ${side / 2}`;
      throw error;
    });
    const isFirst = model !== of, { voxels, seconds, resolution } = JSON.parse(out);
    await viewer.open(files[0], { keepsPlaces: !isFirst });
    const hasColors = viewer.info?.hasColors ?? false;
    done = { resolution: resolution ?? side, voxels, seconds: seconds.total ?? seconds, bytes: bytes + files[0].size, hasColors: hasColors || (!isFirst && (done?.hasColors ?? false)) };
    model = of;
    const warnings = lines.filter((line) => line.includes('warning: '));
    if (warnings.length > 0) ui.toast(plainLine(warnings[0]) + (warnings.length > 1 ? ` (and ${warnings.length - 1} more warnings)` : ''), true);
    ui.refresh();
  });

  const sides = slider({
    label: 'Resolution', min: Math.log2(LEAST), max: Math.log2(MOST), step: 1, whole: true, to: Math.log2, from: (x) => 2 ** x, text: (x) => `${x}³`,
    hint: 'Voxels along the longest side', get: () => resolution, set: (value) => { resolution = value; ui.refresh(); },
  });
  const coloring = toggle({ label: 'Colours', get: () => colors, set: (on) => { colors = on; ui.refresh(); } });
  const filling = toggle({ label: 'Solid', hint: 'Also the voxels inside', get: () => solid, set: (on) => { solid = on; ui.refresh(); } });
  const values = textField({
    label: 'Threshold', most: 30, hint: 'Values from this one on set their voxel; empty: all but 0', get: () => threshold, set: (text) => { threshold = text.trim(); },
  });
  const name = h('p', { class: 'hint' }), forecast = h('p', { class: 'hint', role: 'status' });
  const start = button('Build', () => { if (model) build(model, resolution); }, { primary: true });

  return {
    element: h('div', {}, group('', name, sides.element, coloring.element, filling.element, values.element, forecast, start)),
    refresh(/** @type {import('../settings.js').Settings} */ settings) {
      for (const control of [sides, coloring, filling, values]) control.refresh(settings);
      if (!model || !done) return;
      say(name, `${model.main.name}, ${bytesText(model.main.data.size)}`);
      sides.element.hidden = !isScaled();
      coloring.element.hidden = !done.hasColors;
      filling.element.hidden = model.kind !== 'mesh';
      values.element.hidden = model.kind !== 'volume';
      start.hidden = model.kind === 'voxels';
      forecast.hidden = !isScaled();
      const options = { colors: colors && done.hasColors, solid }, { voxels, seconds, bytes } = expected(done, resolution, options);
      let fits = resolution;
      while (fits > LEAST && expected(done, fits, options).bytes > MOST_BYTES) fits = 2 ** (Math.ceil(Math.log2(fits)) - 1);
      start.disabled = isScaled() && fits < resolution;
      say(forecast, start.disabled ? `It needs about ${bytesText(bytes)} of memory, more than a browser gives. ${fits}³ fits.`
        : `${solid ? 'At least' : `About ${roundText(voxels)} voxels,`} ${bytesText(+bytes.toPrecision(2)).replace(/\.0+ /, ' ')} of memory, ${secondsText(seconds)}${solid ? '; the inside takes more' : ''}.`);
    },
    /** Whether there is a model. */
    hasModel: () => model !== null,
    /** Takes a model: builds its coarse scene and opens the panel. @type {Ui['build']} */
    async take(main, kind, files, note) {
      if (!hasProgram()) throw new Error(`this page cannot build: run \`voxdag ${kind === 'mesh' ? 'build' : 'import'} ${main.name}\` and open the .vdag file`);
      colors = true;
      solid = false;
      threshold = '';
      if (!(await build({ main, kind, files }, COARSE))) return;
      if (kind !== 'voxels') ui.open('build');
      if (note) ui.toast(note);
    },
  };
}
