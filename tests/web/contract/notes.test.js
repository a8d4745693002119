// Contract: notes, which are markers with what is known of how they came, and the report of them.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { ContractClient } from './contract-client.js';
import { Server } from './server.js';
import { POSE } from './stage.js';

const server = await Server.start();
after(() => server.stop());

/** One who has taken control; names differ, for who has left may still be there. */
async function presenting(t, name) {
  const client = await ContractClient.join(t, server, { name });
  await client.ask({ type: 'control', action: 'take' });
  await client.patch({ markers: null, cues: null, measures: null, camera: POSE });
  return client;
}

const pose = ({ eye, focus, up, center, fov }) => ({ eye, focus, up, center, fov });

describe('notes', () => {
  test('have their author, the view that they were made from, and what the client gives', async (t) => {
    const presenter = await presenting(t, 'Bea');
    await presenter.patch({ markers: { Gap: { point: [1, 2, 3], text: 'Too wide', time: 1764345600000 } } });
    const note = presenter.state.markers.Gap;
    assert.deepEqual(note, {
      point: [1, 2, 3], text: 'Too wide', author: 'Bea', time: 1764345600000, view: pose(presenter.state.camera), done: false,
    });
    await presenter.patch({ markers: { Gap: { done: true } }, camera: { fov: 25 } });
    assert.deepEqual(presenter.state.markers.Gap, { ...note, done: true });
    const watcher = await ContractClient.join(t, server, { role: 'view', name: 'Guest' });
    assert.deepEqual(watcher.state.markers, presenter.state.markers);
    await watcher.refused({ type: 'patch', patch: { markers: { Gap: { done: false } } } }, 'not-allowed', { valid: true });
    const id = watcher.send({ type: 'snapshot', width: 64, height: 48, camera: note.view });
    const { header } = await watcher.until('its picture', () => watcher.frames.find((frame) => frame.header.snapshot === id));
    assert.deepEqual(pose(header.camera), note.view);
  });

  test('come back as they were: null is not filled in', async (t) => {
    const presenter = await presenting(t, 'Ada');
    await presenter.patch({ markers: { Old: { point: [0, 0, 0], author: null, view: null } } });
    assert.deepEqual(presenter.state.markers, { Old: { point: [0, 0, 0], text: '', done: false } });
  });
});

describe('the report', () => {
  test('is one file that refers to nothing else, with a picture of each note, cue and view', async (t) => {
    const presenter = await presenting(t, 'Eva');
    const pick = (points) => ({ node: 4, snap: 'point', points: [points] });
    await presenter.patch({
      markers: { Gap: { point: [1, 2, 3], text: '<script>alert(1)</script>', time: 1764345600000, done: true } },
      cues: { Arrival: { text: 'Welcome' } },
      measures: { Width: { kind: 'distance', picks: [pick([0, 0, 0]), pick([0.5, 0, 0])] } },
    });
    const answer = await server.get('report.html');
    assert.equal(answer.status, 200);
    assert.match(answer.headers.get('content-type'), /^text\/html/);
    const html = await answer.text();
    assert.equal([...html.matchAll(/<img [^>]*src="data:image\/jpeg;base64,[A-Za-z0-9+/=]{1000,}"/g)].length, 3);
    assert.equal(/<script|<link|https?:/.test(html), false);
    for (const words of ['Report of stage', '&lt;script&gt;alert(1)', 'Eva', '2025-11-28 16:00 UTC', 'Welcome', 'Width', '500.0 mm']) {
      assert.ok(html.includes(words), words);
    }
  });

  test('has a table of the notes', async (t) => {
    const presenter = await presenting(t, 'Ivo');
    await presenter.patch({ markers: { Gap: { point: [1, 2, 3], node: 4, text: '=1+1, "Ž"', time: 1764345600000 } } });
    const answer = await server.get('report.csv');
    assert.match(answer.headers.get('content-type'), /^text\/csv/);
    assert.equal(Buffer.from(await answer.arrayBuffer()).toString(),
      '\ufeffname,text,author,time,done,x,y,z,node\r\nGap,"\'=1+1, ""Ž""",Ivo,2025-11-28T16:00:00Z,false,1,2,3,4\r\n');
  });
});
