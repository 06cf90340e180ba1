import assert from 'node:assert/strict';
import { test } from 'node:test';

import { clipOf } from '../../apps/viewer/page/ui/swipe.js';

test('the second picture is shown right of the line, wholly or not at all', () => {
  assert.equal(clipOf('both', 0.25), 'inset(0 0 0 25%)');
  assert.equal(clipOf('both', 1 / 3), 'inset(0 0 0 33.333%)');
  assert.equal(clipOf('both', -1), 'inset(0 0 0 0%)');
  assert.equal(clipOf('both', 7), 'inset(0 0 0 100%)');
  assert.equal(clipOf('first', 0.25), 'inset(0 0 0 100%)');
  assert.equal(clipOf('second', 0.25), 'inset(0 0 0 0%)');
});
