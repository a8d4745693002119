import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { mergePatch } from '../../../web-client/base/merge-patch.js';
import { asItWas, noteNames, pictureOfNote, placeInPicture } from '../../../web-client/base/notes.js';
import { setLanguage } from '../../../web-client/base/texts.js';
import { fetchFile } from '../../../web-client/connection/files.js';
import { byWords, noteEntries } from '../../../web-client/panels/notes-section.js';

const view = { eye: [0, 0, 5], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 40 };

afterEach(() => setLanguage('en'));

describe('notes', () => {
  test('follow each other by their time, and those of before it was known come first, by name', () => {
    const notes = { b: {}, late: { time: 9 }, early: { time: 3 }, a: {} };
    assert.deepEqual(noteNames(notes), ['a', 'b', 'early', 'late']);
    assert.deepEqual(noteNames({}), []);
  });

  test('are lost where the frame does not have them, unless they were made from a view', () => {
    const all = { a: { text: 'Scratch' }, b: { text: '' }, c: { text: '', view } };
    const drawn = { markers: { a: [0, 0, 0], c: [0, 0, 0] }, view: { width: 200, height: 100 } };
    const entries = noteEntries(all, drawn);
    assert.deepEqual(entries.map(([name, { lost }]) => [name, lost]), [['a', false], ['b', true], ['c', false]]);
    assert.deepEqual(entries.map(([, { at }]) => at), [undefined, undefined, { x: 0.5, y: 0.5 }]);
    assert.deepEqual(noteEntries(all, undefined).map(([, { lost }]) => lost), [true, true, false]);
  });

  test('come back as they were: what they did not have is not filled in', () => {
    assert.deepEqual(asItWas({ point: [0, 0, 0], text: 'x' }), { point: [0, 0, 0], text: 'x', author: null, view: null });
    const note = { point: [0, 0, 0], text: 'x', author: 'Bea', time: 5, view, done: true };
    assert.deepEqual(mergePatch({}, asItWas(note)), note);
  });

  test('lie somewhere in their pictures, in the middle where they are outside', () => {
    const seen = { ...view, fov: 90 }; // from 5 away, 10 high
    const at = (point, aspect = 2) => Object.values(placeInPicture(seen, point, aspect)).map((part) => Number(part.toFixed(6)));
    assert.deepEqual(at([0, 0, 0]), [0.5, 0.5]);
    assert.deepEqual(at([5, 2.5, 0]), [0.75, 0.25]);
    assert.deepEqual(at([2.5, -2.5, 0], 1), [0.75, 0.75]);
    assert.deepEqual(at([5, 2.5, -5]), [0.625, 0.375]);
    for (const outside of [[11, 0, 0], [0, -6, 0], [1, 1, 9], [0, 0, 5]]) assert.deepEqual(at(outside), [0.5, 0.5], String(outside));
    assert.deepEqual(Object.values(placeInPicture({ ...seen, eye: [5, 0, 0] }, [0, 0, -2.5], 1)), [0.75, 0.5]);
  });

  test('look another where their view or their place is another, and not for another text', () => {
    const note = { point: [1, 2, 3], text: 'a', done: false, view };
    const { look, request } = pictureOfNote({ note }, 'note');
    assert.deepEqual(request, { camera: view });
    assert.equal(pictureOfNote({ note: { ...note, text: 'b', done: true } }, 'note').look, look);
    assert.notEqual(pictureOfNote({ note: { ...note, point: [1, 2, 4] } }, 'note').look, look);
    assert.notEqual(pictureOfNote({ note: { ...note, view: { ...view, fov: 41 } } }, 'note').look, look);
    assert.equal(pictureOfNote({ note: { point: [1, 2, 3] } }, 'note'), undefined);
    assert.equal(pictureOfNote({}, 'note'), undefined);
  });

  test('say who wrote them and when, as far as that is known, in the user\'s language', async () => {
    const time = new Date(2026, 10, 28, 16, 5).getTime();
    assert.match(byWords({ author: 'iPad', time }), /^iPad · Nov 28, 2026, 4:05\sPM$/);
    assert.equal(byWords({ author: 'iPad' }), 'iPad');
    assert.equal(byWords({}), '');
    await setLanguage('cs');
    assert.equal(byWords({ time }).replaceAll('\u00a0', ' '), '28. 11. 2026 16:05');
  });
});

describe('a file of the server', () => {
  const page = 'http://host/rooms/a/';
  const answers = (t, answer) => t.mock.method(globalThis, 'fetch', async () => answer());

  test('is asked for with the token, where there is one', async (t) => {
    const fetched = answers(t, () => new Response('text'));
    assert.equal(await (await fetchFile('report.csv', 'secret', page)).text(), 'text');
    await fetchFile('report.csv', undefined, page);
    const [withToken, without] = fetched.mock.calls.map(({ arguments: [address, { headers }] }) => [address.href, headers]);
    assert.deepEqual(withToken, ['http://host/rooms/a/report.csv', { Authorization: 'Bearer secret' }]);
    assert.deepEqual(without[1], {});
  });

  test('that does not come is an error with the server\'s sentence, or without a connection', async (t) => {
    answers(t, () => new Response('too many reports\n', { status: 503 }));
    await assert.rejects(fetchFile('report.html', undefined, page), { message: 'too many reports' });
    answers(t, () => { throw new TypeError(); });
    await assert.rejects(fetchFile('report.html', undefined, page), { code: 'not-sent' });
  });
});
