/** The page's files that are no modules. pack.mjs puts them into modules, so that bundlers take them; each is loaded when it is needed. */

/** By the folder of the page. @type {{[folder: string]: () => Promise<{default: {[path: string]: string}}>}} */
const GROUPS = {
  build: () => import('./texts/build.js'),
  file: () => import('./texts/file.js'),
  gpu: () => import('./texts/gpu.js'),
};

/** Returns the text of a file; base64 of a .gz. @param {string} path */
export async function text(path) {
  const { default: texts } = await GROUPS[path.split('/')[0]]();
  return texts[path];
}
