import { Connection, socketAddress, tokenFrom } from './connection.js';
import { Input } from './input.js';
import { Picture } from './picture.js';
import { Status, connectionSentence } from './status.js';
import { watchViewSize } from './view-size.js';

const canvas = document.getElementById('view');
const status = new Status(document.getElementById('status'));
const picture = new Picture(canvas);
const token = tokenFrom(location.hash);

let phase = { name: 'connecting' };
let hasPicture = false;
const noticesSeen = new Set();

const connection = new Connection({
  url: socketAddress(document.baseURI),
  hello: { role: 'control', token },
  on: {
    phase(now) {
      phase = now;
      hasPicture = false;
      if (phase.name !== 'open') canvas.classList.add('stale');
      input.enabled = phase.name === 'open' && connection.role === 'control';
      sayPhase();
    },

    async frame(frame) {
      const outcome = await picture.show(frame);
      if (outcome === 'failed') status.pass('A picture from the server could not be read.');
      if (outcome !== 'drawn' || phase.name !== 'open' || hasPicture) return;
      hasPicture = true;
      canvas.classList.remove('stale');
      sayPhase();
    },

    state(state) {
      const notices = state.scene?.notices ?? [];
      const news = notices.filter((notice) => !noticesSeen.has(notice));
      if (news.length > 0) status.pass(news.join(' · '));
      for (const notice of notices) noticesSeen.add(notice);
    },

    error({ message }) {
      status.pass(message);
    },

    message({ type, scene, done, refused }) {
      if (type !== 'loading') return;
      if (refused) status.pass(refused);
      else if (!done) status.pass(`Loading ${scene}…`);
    },
  },
});

const input = new Input(canvas, {
  send: (message) => connection.send(message),
  mapping: () => picture.mapping(),
  // A server that has begun anew knows nothing of the frames before.
  frame: () => (hasPicture ? picture.header.frame : undefined),
});

function sayPhase() {
  const sentence = connectionSentence(phase, hasPicture, Boolean(token));
  if (sentence !== null) status.hold(sentence);
}

watchViewSize(canvas, (size) => {
  picture.layout();
  connection.resize(size);
});

document.addEventListener('visibilitychange', () => {
  if (document.visibilityState === 'visible') connection.wake();
});
window.addEventListener('online', () => connection.wake());
window.addEventListener('pageshow', (event) => {
  if (event.persisted) connection.wake();
});
// Another token in the address: another start.
window.addEventListener('hashchange', () => location.reload());

status.hold('Connecting…');
connection.start();
