/** The picture: see docs/viewer.md. */
import { Hands as PageHands } from './page/hands/hands.js';
import { createViewer as createPageViewer } from './page/viewer.js';

/** @type {typeof import('./index.js').createViewer} */
export const createViewer = ({ bytes, ...options }) =>
  createPageViewer({ ...options, bytes: /** @type {BlobPart | undefined} */ (bytes), empty: options.url === undefined && bytes === undefined });

/** @type {typeof import('./index.js').Hands} */
export const Hands = PageHands;
