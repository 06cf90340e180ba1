/** Tells the name of an icon that a finger rests on: touch screens have no pointer that hovers. */

/** Milliseconds of a long press, and pixels that a finger may move in it. */
const LONG_MS = 450, SLACK = 10;

/** Calls `tell` with the name of a button or a choice that is pressed for long; it is then not used. @param {HTMLElement} container @param {(name: string) => void} tell */
export function nameOnLongPress(container, tell) {
  let timer = 0, x = 0, y = 0, wasLong = false;
  const end = () => clearTimeout(timer);
  container.addEventListener('pointerdown', (event) => {
    end();
    wasLong = false;
    const target = event.target instanceof Element ? event.target.closest('button[title], label[title]') : null;
    if (event.pointerType === 'mouse' || !target) return;
    [x, y] = [event.clientX, event.clientY];
    timer = setTimeout(() => {
      wasLong = true;
      tell(target.getAttribute('title') ?? '');
    }, LONG_MS);
  });
  container.addEventListener('pointermove', (event) => { if (Math.hypot(event.clientX - x, event.clientY - y) > SLACK) end(); });
  for (const type of ['pointerup', 'pointercancel']) container.addEventListener(type, end);
  container.addEventListener('contextmenu', (event) => { if (wasLong) event.preventDefault(); });
  container.addEventListener('click', (event) => {
    if (!wasLong) return;
    wasLong = false;
    event.preventDefault();
    event.stopPropagation();
  }, { capture: true });
}
