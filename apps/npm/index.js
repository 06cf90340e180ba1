/** The entry for browsers. */
import { provide } from './page/file/host.js';
import { text } from './texts.js';

provide({ text });

export { build } from './build.js';
export { run } from './run.js';
export { open } from './scene.js';
export { Hands, createViewer } from './viewer.js';
