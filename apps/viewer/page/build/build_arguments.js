/** The command line that builds a scene of a model. */

/** @typedef {{main: import('./input_kinds.js').NamedFile, kind: import('./input_kinds.js').Kind}} Model  The file to build; the program sees it in /in. */
/** @typedef {{resolution?: number, colors: boolean, solid: boolean, threshold?: string}} BuildSettings  `resolution`: voxels along the longest side; `threshold`: of a volume. */

/** Returns it; the program writes /out/NAME.vdag. @param {Model} model @param {BuildSettings} settings */
export function buildArguments({ main, kind }, { resolution, colors, solid, threshold = '' }) {
  const name = main.name.split('/').pop()?.replace(/\.\w+(\.gz|\.zst)?$/i, '') || 'scene', ends = ['--json', '-o', `/out/${name}.vdag`];
  const side = resolution === undefined ? [] : ['-r', String(resolution)];
  if (kind === 'mesh') return ['build', `/in/${main.name}`, ...side, ...(colors ? ['--color-if-any'] : []), ...(solid ? ['--solid', 'winding'] : []), ...ends];
  const values = kind === 'volume' && threshold !== '' ? ['--threshold', threshold] : [];
  return ['import', `/in/${main.name}`, ...(kind === 'points' ? side : []), ...(colors ? [] : ['--no-color']), ...values, ...ends];
}
