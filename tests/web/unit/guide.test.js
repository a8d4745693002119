import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { DRAWING, gesturesDrawing } from '../gestures-drawing.mjs';

test('the guide draws the gestures as the help does', () => {
  assert.ok(readFileSync(DRAWING, 'utf8') === gesturesDrawing(), 'another drawing: run tests/web/gestures-drawing.mjs');
});
