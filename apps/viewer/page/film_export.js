/** Films of a camera path, made by the browser: a WebM of what the page shows, or frames in full quality. */
import { Zip } from './file/zip.js';
import { cameraAt, frameTimes } from './hands/camera_path.js';

/**
 * @typedef {import('./viewer_types.js').Viewer} Viewer
 * @typedef {import('./hands/camera_path.js').Key} Key
 * @typedef {import('./ui/job.js').Job} Job
 */

/** Bits per second of a WebM. */
const BIT_RATE = 16e6;

/** Returns the kind of video that the browser can record, or null. */
export function videoKind() {
  if (typeof MediaRecorder === 'undefined' || !('captureStream' in HTMLCanvasElement.prototype)) return null;
  return ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'].find((kind) => MediaRecorder.isTypeSupported(kind)) ?? null;
}

/**
 * Records the canvas while the camera moves along the path, in real time.
 * @param {Viewer} viewer @param {Key[]} keys @param {string} kind  Of videoKind(). @param {Job} job @returns {Promise<Blob>}
 */
export async function recordVideo(viewer, keys, kind, { signal, progress }) {
  const begin = keys[0].time, seconds = keys[keys.length - 1].time - begin;
  /** @type {Blob[]} */
  const parts = [];
  const stream = viewer.canvas.captureStream();
  const recorder = new MediaRecorder(stream, { mimeType: kind, videoBitsPerSecond: BIT_RATE });
  recorder.ondataavailable = (event) => parts.push(event.data);
  const stopped = new Promise((resolve, reject) => {
    recorder.onstop = () => resolve(undefined);
    recorder.onerror = () => reject(new Error('the browser cannot record this picture'));
  });
  recorder.start();
  try {
    const from = performance.now();
    for (let passed = 0; passed < seconds && !signal.aborted;) {
      const now = await new Promise((resolve) => requestAnimationFrame(resolve));
      passed = Math.min(Math.max(0, (now - from) / 1000), seconds);
      viewer.set({ camera: cameraAt(keys, begin + passed) }, 'film');
      progress(passed / seconds);
    }
  } finally {
    if (recorder.state !== 'inactive') recorder.stop();
    for (const track of stream.getTracks()) track.stop();
  }
  await stopped;
  signal.throwIfAborted();
  return new Blob(parts, { type: 'video/webm' });
}

/**
 * Renders the frames of a film in full quality, as PNGs in a ZIP: frame_0000.png and so on, as `voxdag render --path` names them.
 * @param {Viewer} viewer @param {Key[]} keys @param {{perSecond: number, width?: number, height?: number, samples: number}} film
 * @param {Job} job @returns {Promise<Blob>}
 */
export async function renderFrames(viewer, keys, { perSecond, ...size }, { signal, progress }) {
  const zip = new Zip(), times = frameTimes(keys, perSecond);
  for (const [i, time] of times.entries()) {
    const part = (/** @type {number} */ done) => progress((i + done) / times.length);
    const frame = await viewer.capture({ ...size, camera: cameraAt(keys, time), signal, progress: part });
    await zip.add(`frame_${String(i).padStart(4, '0')}.png`, frame);
  }
  return zip.finish();
}
