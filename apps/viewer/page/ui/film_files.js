/** The part of the panel "Camera path" that saves a film: the path, a video, or frames. */
import { completeKeys, frameTimes, pathToJson } from '../hands/camera_path.js';
import { recordVideo, renderFrames, videoKind } from '../film_export.js';
import { button, choice, group } from './controls.js';
import { download, h, say } from './dom.js';

const SIZES = ['854x480', '1280x720', '1920x1080', '3840x2160'];

/** @param {import('./interface.js').Ui} ui @param {() => void} stop  Ends the film that plays. */
export function filmFiles(ui, stop) {
  const { viewer } = ui;
  let size = '1280x720', rate = '30';
  const keys = () => completeKeys(viewer.get().path, ui.home());
  const kind = videoKind();
  const path = button('Save path', () =>
    download(`${ui.name()}.path.json`, new Blob([pathToJson(viewer.get().path, viewer.get().sun.direction)], { type: 'application/json' })));
  const video = button('Record video', async () => {
    stop();
    const done = await ui.job('Video', async (job) => {
      if (kind !== null) download(`${ui.name()}.webm`, await recordVideo(viewer, keys(), kind, job));
    });
    if (done) ui.toast('Saved as WebM');
  }, { title: kind === null ? 'This browser records no video' : 'Records the picture of this window while the film plays' });
  const frames = button('Save frames', async () => {
    stop();
    const [width, height] = size.split('x').map(Number);
    const done = await ui.job('Frames', async (job) =>
      download(`${ui.name()}.frames.zip`, await renderFrames(viewer, keys(), { perSecond: Number(rate), width, height, samples: 16 }, job)));
    if (done) ui.toast('Saved as PNGs in a ZIP file');
  }, { title: 'Renders each frame in full quality' });
  const sizes = choice({
    label: 'Size of frames', options: SIZES.map((name) => [name, name.replace('x', ' × ')]), get: () => size, set: (value) => { size = value; },
  });
  const rates = choice({
    label: 'Frames per second', options: [['24', '24'], ['25', '25'], ['30', '30'], ['60', '60']], get: () => rate,
    set: (value) => { rate = value; showCount(); },
  });
  const count = h('p', { class: 'hint' });
  const showCount = () => say(count, viewer.get().path.length < 2 ? '' : `${frameTimes(keys(), Number(rate)).length} frames, 16 samples per pixel each.`);
  const element = group('Save', h('div', { class: 'buttons' }, path, video), sizes.element, rates.element, h('div', { class: 'buttons' }, frames), count);
  return {
    element,
    refresh(/** @type {import('../settings.js').Settings} */ settings) {
      element.hidden = settings.path.length === 0;
      video.disabled = settings.path.length < 2 || kind === null;
      frames.disabled = settings.path.length < 2;
      for (const control of [sizes, rates]) control.refresh(settings);
      showCount();
    },
  };
}
