/** A picture in full quality, as PNG. */
import { finished, makeTarget, makeTexture } from './gl_tools.js';
import { Picture } from './picture.js';

/**
 * Renders all samples of a picture, in parts between which the page can breathe. The shot's `samples`
 * tell how many there are. `progress` takes the part that is done, from 0 to 1. Throws Error if size or samples are not
 * possible, or the graphics card is lost, and the signal's reason once it is aborted.
 * @param {import('./renderer.js').Renderer} renderer @param {import('./pacer.js').Pacer} pacer
 * @param {import('./renderer.js').Shot} shot @param {number} width @param {number} height  Pixels.
 * @param {{signal?: AbortSignal, progress?: (part: number) => void}} [job]
 * @returns {Promise<Blob>}
 */
export async function capture(renderer, pacer, shot, width, height, { signal, progress } = {}) {
  const { gl } = renderer, most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  if (!(Number.isInteger(shot.samples) && shot.samples >= 1)) throw new Error('a picture has a whole number of samples, at least 1');
  for (const side of [width, height])
    if (!(Number.isInteger(side) && side >= 1 && side <= most)) throw new Error(`a picture's sides are whole numbers from 1 to ${most}`);
  const picture = new Picture(gl, width, height);
  try {
    while (picture.samples < shot.samples) {
      const begin = performance.now(), rows = Math.min(pacer.rows(width, height), height - picture.rows);
      renderer.render(picture, shot, rows);
      await finished(gl);
      signal?.throwIfAborted();
      if (gl.isContextLost()) throw new Error('the graphics card was lost');
      progress?.((picture.samples + picture.rows / height) / shot.samples);
      pacer.learn(false, rows * width, performance.now() - begin);
    }
    const exposure = shot.settings.exposure > 0 ? shot.settings.exposure : renderer.exposureOf(picture);
    return await toPng(readPixels(renderer, picture, exposure), width, height);
  } finally {
    picture.delete();
  }
}

/**
 * Returns the colours of a picture as it is shown: 4 bytes per pixel, rows from the bottom.
 * @param {import('./renderer.js').Renderer} renderer @param {Picture} picture @param {number} exposure
 */
export function readPixels(renderer, picture, exposure) {
  const { gl } = renderer, { width, height } = picture;
  const texture = makeTexture(gl, gl.RGBA8, width, height), target = makeTarget(gl, [texture]);
  renderer.display(picture, exposure, target, width, height);
  const pixels = new Uint8ClampedArray(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  gl.deleteFramebuffer(target);
  gl.deleteTexture(texture);
  return pixels;
}

/** @param {Uint8ClampedArray} pixels  Rows from the bottom. @param {number} width @param {number} height @returns {Promise<Blob>} */
function toPng(pixels, width, height) {
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width, height });
  const image = new ImageData(width, height), stride = 4 * width;
  for (let row = 0; row < height; ++row)
    image.data.set(pixels.subarray(stride * (height - 1 - row), stride * (height - row)), stride * row);
  const context = canvas.getContext('2d');
  if (context === null) throw new Error('the browser has no canvas of this size');
  context.putImageData(image, 0, 0);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob === null ? reject(new Error('the browser writes no PNG of this size')) : resolve(blob)), 'image/png'));
}
