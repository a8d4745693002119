import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { Connection, roleFrom, socketAddress, tokenFrom } from '../../../web-client/connection/connection.js';
import { FakeClock, FakeSocket, jpegWith, replaceGlobals } from './fakes.js';

const SIZE = { width: 1180, height: 820, pixelRatio: 2 };
const WELCOME = { type: 'welcome', version: 1, client: 'a', role: 'control' };
const STATE = { type: 'state', revision: 5, state: { camera: { fov: 40 }, control: { holder: 'b' } } };

let restore = () => {};

afterEach(() => restore());

/** A connection, all that it is surrounded by, and a log of what it tells. */
function setUp({ role = 'control', token, resume, random = () => 1 } = {}) {
  const page = { sockets: [], phases: [], sent: [], frames: [], states: [], errors: [], messages: [], asked: [], clock: new FakeClock() };
  page.connection = new Connection({
    url: 'ws://server/ws',
    hello: () => ({ role, token, resume }),
    on: {
      phase: (phase) => page.phases.push(phase),
      sent: (message) => page.sent.push(message),
      frame: (frame) => new Promise((drawn) => page.frames.push({ ...frame, drawn })),
      state: (state) => page.states.push(state),
      error: (error) => page.errors.push(error),
      message: (message) => page.messages.push(message),
    },
  });
  restore = replaceGlobals({
    WebSocket: class extends FakeSocket {
      constructor(url, protocol) {
        super(url, protocol);
        page.sockets.push(this);
      }
    },
    fetch: async (address) => {
      const { answer } = page;
      page.asked.push(address);
      if (!answer) throw new TypeError();
      return { ...answer, text: async () => answer.text };
    },
    location: { origin: 'https://desk.example' },
    setTimeout: page.clock.setTimeout,
    clearTimeout: page.clock.clearTimeout,
    Math: Object.create(Math, { random: { value: random } }),
  });
  Object.defineProperties(page, {
    socket: { get: () => page.sockets.at(-1) },
    phase: { get: () => page.phases.at(-1) },
  });
  return page;
}

/** The same with a hello that has been answered; what was sent until then is forgotten. */
function setUpOpen(options) {
  const page = setUp(options);
  page.connection.start();
  answerHello(page);
  page.socket.take();
  return page;
}

function answerHello(page, welcome = WELCOME, state = STATE) {
  page.socket.opens();
  page.socket.says(welcome);
  page.socket.says(state);
}

/** Lets what was promised happen. */
const settle = () => new Promise((done) => setImmediate(done));

describe('hello', () => {
  test('is the first message, with the token', () => {
    const page = setUp({ token: 'abc' });
    page.connection.start();
    assert.equal(page.socket.url, 'ws://server/ws');
    assert.equal(page.socket.protocol, 'vrut-preview.v1');
    assert.deepEqual(page.socket.take(), []);
    page.socket.opens();
    assert.deepEqual(page.socket.take(), [{ type: 'hello', role: 'control', token: 'abc' }]);
    assert.equal(page.phase.name, 'connecting');
  });

  test('when answered, the size goes out, then two grants', () => {
    const page = setUp();
    page.connection.resize(SIZE);
    page.connection.start();
    page.socket.opens();
    page.socket.take();
    page.socket.says(WELCOME);
    assert.deepEqual(page.socket.take(), []);
    page.socket.says(STATE);
    assert.deepEqual(page.socket.take(), [
      { type: 'resize', ...SIZE, id: 1 },
      { type: 'frame' },
      { type: 'frame' },
    ]);
    assert.equal(page.phase.name, 'open');
    assert.equal(page.connection.role, 'control');
  });

  test('with a resume key, again after a lost connection: the server knows the page by it', () => {
    const page = setUp({ resume: 'secret' });
    page.connection.start();
    page.socket.opens();
    assert.equal(page.socket.take()[0].resume, 'secret');
    page.socket.ends(1006);
    page.clock.advance(page.clock.next);
    page.socket.opens();
    assert.equal(page.socket.take()[0].resume, 'secret');
  });

  test('takes no control from anybody, and asks for none', () => {
    for (const control of [{}, { holder: 'b' }]) {
      const page = setUp();
      page.connection.start();
      answerHello(page, WELCOME, { ...STATE, state: { control } });
      assert.deepEqual(page.socket.take().map(({ type }) => type), ['hello', 'frame', 'frame']);
    }
  });
});

describe('messages', () => {
  test('carry rising ids', () => {
    const page = setUpOpen();
    assert.equal(page.connection.send({ type: 'fit' }), 1);
    assert.equal(page.connection.send({ type: 'fit' }), 2);
    page.connection.resize(SIZE);
    const messages = [{ type: 'fit', id: 1 }, { type: 'fit', id: 2 }, { type: 'resize', ...SIZE, id: 3 }];
    assert.deepEqual(page.socket.take(), messages);
    assert.deepEqual(page.sent, messages);
  });

  test('are dropped while there is nobody to hear them', () => {
    const page = setUp();
    assert.equal(page.connection.send({ type: 'fit' }), 0);
    page.connection.start();
    page.socket.opens();
    page.socket.take();
    assert.equal(page.connection.send({ type: 'fit' }), 0);
    assert.deepEqual(page.socket.take(), []);
  });

  test('the state document follows its patches', () => {
    const page = setUpOpen();
    page.socket.says({ type: 'patch', revision: 6, patch: { camera: { fov: 50 }, control: { holder: null } } });
    assert.deepEqual(page.connection.state, { camera: { fov: 50 }, control: {} });
    assert.equal(page.connection.revision, 6);
    assert.equal(page.states.length, 2);
    page.socket.says({ type: 'state', revision: 7, state: { camera: { fov: 30 } } });
    assert.deepEqual(page.connection.state, { camera: { fov: 30 } });
  });

  test('errors and other messages are passed on; what is no message is not', () => {
    const page = setUpOpen();
    page.socket.says({ type: 'error', code: 'not-in-control', message: 'Another steers.' });
    page.socket.says({ type: 'loading', scene: 'car', fraction: 0.5 });
    page.socket.says('{"type":');
    page.socket.says('null');
    page.socket.says('{}');
    assert.deepEqual(page.errors.map(({ message }) => message), ['Another steers.']);
    assert.deepEqual(page.messages, [{ type: 'loading', scene: 'car', fraction: 0.5 }]);
  });
});

describe('frames', () => {
  test('each grant is given back when its frame is drawn', async () => {
    const page = setUpOpen();
    page.socket.sendsFrame(jpegWith({ frame: 1 }));
    page.socket.sendsFrame(jpegWith({ frame: 2 }));
    await settle();
    assert.deepEqual(page.frames.map(({ header }) => header.frame), [1, 2]);
    assert.deepEqual(page.socket.take(), []);
    page.frames[1].drawn();
    await settle();
    assert.deepEqual(page.socket.take(), [{ type: 'frame', shown: 2 }]);
    page.frames[0].drawn();
    await settle();
    assert.deepEqual(page.socket.take(), [{ type: 'frame', shown: 1 }]);
  });

  test('a frame of an unreadable header is passed on without one', () => {
    const page = setUpOpen();
    page.socket.sendsFrame(new ArrayBuffer(3));
    assert.equal(page.frames[0].header, null);
    assert.equal(page.frames[0].data.byteLength, 3);
  });

  test('a frame of the lost connection gives the new one no grant', async () => {
    const page = setUpOpen();
    page.socket.sendsFrame(jpegWith({ frame: 1 }));
    page.socket.ends(1006);
    page.clock.advance(250);
    answerHello(page);
    page.socket.take();
    page.frames[0].drawn();
    await settle();
    assert.deepEqual(page.socket.take(), []);
  });
});

describe('a lost connection', () => {
  test('is tried again after ever longer pauses, up to 4 s', () => {
    const page = setUpOpen();
    page.socket.ends(1006);
    const pauses = [];
    for (let i = 0; i < 7; i += 1) {
      pauses.push(page.clock.next);
      assert.equal(page.phase.name, 'waiting');
      assert.equal(page.phase.retryMs, page.clock.next);
      assert.equal(page.phase.hadOpened, i === 0);
      page.clock.advance(page.clock.next);
      assert.equal(page.phase.name, 'connecting');
      page.socket.ends(1006);
    }
    assert.deepEqual(pauses, [250, 500, 1000, 2000, 4000, 4000, 4000]);
  });

  test('the pauses are spread over their second half', () => {
    const page = setUpOpen({ random: () => 0 });
    page.socket.ends(1006);
    assert.equal(page.clock.next, 125);
  });

  test('everything is restored: hello, size, grants, state, ids that still rise', () => {
    const page = setUpOpen();
    page.connection.resize(SIZE);
    page.socket.ends(1001);
    assert.equal(page.connection.role, undefined);
    assert.deepEqual(page.connection.state, STATE.state);
    page.clock.advance(250);
    answerHello(page, WELCOME, { ...STATE, revision: 1 });
    assert.deepEqual(page.socket.take(), [
      { type: 'hello', role: 'control' },
      { type: 'resize', ...SIZE, id: 2 },
      { type: 'frame' },
      { type: 'frame' },
    ]);
    assert.equal(page.connection.revision, 1);
  });

  test('a picture makes the pauses short again, a welcome alone does not', () => {
    const page = setUpOpen();
    const loseAndReopen = () => {
      page.socket.ends(1006);
      const pause = page.clock.next;
      page.clock.advance(pause);
      answerHello(page);
      return pause;
    };
    assert.deepEqual([loseAndReopen(), loseAndReopen()], [250, 500]);
    page.socket.sendsFrame(jpegWith({ frame: 1 }));
    assert.equal(loseAndReopen(), 250);
  });

  test('a page that is seen again does not wait', () => {
    const page = setUpOpen();
    page.socket.ends(1006);
    page.connection.wake();
    assert.equal(page.sockets.length, 2);
    assert.equal(page.phase.name, 'connecting');
    page.connection.wake();
    page.clock.advance(250);
    assert.equal(page.sockets.length, 2);
  });

  test('a server that never answers the hello is given up', () => {
    const page = setUp();
    page.connection.start();
    const [silent] = page.sockets;
    page.clock.advance(8000);
    assert.equal(page.phase.name, 'waiting');
    assert.ok(silent.closed);
    page.clock.advance(250);
    answerHello(page);
    assert.equal(page.phase.name, 'open');
  });

  test('a page that is seen again finds out that its connection is dead', () => {
    const page = setUpOpen();
    page.connection.wake();
    assert.deepEqual(page.socket.take(), [{ type: 'tree', depth: 0, id: 1 }]);
    page.clock.advance(3999);
    assert.equal(page.phase.name, 'open');
    page.clock.advance(1);
    assert.equal(page.phase.name, 'waiting');
    assert.ok(page.phase.hadOpened);
  });

  test('or alive', () => {
    const page = setUpOpen();
    page.connection.wake();
    page.socket.says({ type: 'tree', id: 1, nodes: [] });
    page.clock.advance(4000);
    assert.equal(page.phase.name, 'open');
  });
});

describe('a silent connection', () => {
  test('is asked after 5 s, and given up 10 s later', () => {
    const page = setUpOpen();
    page.clock.advance(4999);
    assert.deepEqual(page.socket.take(), []);
    page.clock.advance(1);
    assert.deepEqual(page.socket.take(), [{ type: 'tree', depth: 0, id: 1 }]);
    page.clock.advance(9999);
    assert.equal(page.phase.name, 'open');
    page.clock.advance(1);
    assert.equal(page.phase.name, 'waiting');
    assert.ok(page.phase.hadOpened);
    assert.ok(page.sockets[0].closed);
  });

  test('that answers is asked again after the next silence', () => {
    const page = setUpOpen();
    page.clock.advance(5000);
    page.socket.take();
    page.clock.advance(9000);
    page.socket.says({ type: 'tree', id: 1, nodes: [] });
    page.clock.advance(4999);
    assert.deepEqual(page.socket.take(), []);
    page.clock.advance(1);
    assert.deepEqual(page.socket.take().map(({ type }) => type), ['tree']);
  });

  test('is not silent while anything comes: a frame, a patch, an answer', () => {
    const page = setUpOpen();
    const comes = [
      () => page.socket.sendsFrame(jpegWith({ frame: 1 })),
      () => page.socket.says({ type: 'patch', revision: 6, patch: {} }),
      () => page.socket.says({ type: 'ok', id: 1, revision: 6 }),
    ];
    for (const something of comes) {
      page.clock.advance(4000);
      something();
    }
    page.clock.advance(4999);
    assert.deepEqual(page.socket.take(), []);
  });
});

describe('a question', () => {
  test('is settled by the answer of its id, which is told to nobody else', async () => {
    const page = setUpOpen();
    const asked = [page.connection.ask({ type: 'tree' }), page.connection.ask({ type: 'patch', patch: {} })];
    assert.deepEqual(page.socket.take().map(({ id }) => id), [1, 2]);
    page.socket.says({ type: 'ok', id: 2, revision: 6 });
    page.socket.says({ type: 'tree', id: 1, nodes: [] });
    assert.deepEqual(await Promise.all(asked), [{ type: 'tree', id: 1, nodes: [] }, { type: 'ok', id: 2, revision: 6 }]);
    assert.deepEqual(page.messages, []);
  });

  test('is refused with the error of the server', async () => {
    const page = setUpOpen();
    const asked = page.connection.ask({ type: 'patch', patch: {} });
    page.socket.says({ type: 'error', id: 1, code: 'not-in-control', message: 'Another steers.' });
    await assert.rejects(asked, { code: 'not-in-control', message: 'Another steers.' });
    assert.deepEqual(page.errors, []);
  });

  test('for a snapshot is settled by the frame, which uses no grant and is not for the view', async () => {
    const page = setUpOpen();
    const asked = page.connection.ask({ type: 'snapshot', width: 8, height: 8 });
    page.socket.take();
    const jpeg = jpegWith({ frame: 3, snapshot: 1 });
    page.socket.sendsFrame(jpeg);
    assert.deepEqual(await asked, { header: { frame: 3, snapshot: 1 }, data: jpeg });
    await settle();
    assert.deepEqual(page.frames, []);
    assert.deepEqual(page.socket.take(), []);
  });

  test('is lost with the connection, and where there is none', async () => {
    const page = setUpOpen();
    const asked = page.connection.ask({ type: 'tree' });
    page.socket.ends(1006);
    await assert.rejects(asked, { message: '' });
    await assert.rejects(page.connection.ask({ type: 'tree' }), { message: '', code: 'not-sent' });
  });
});

describe('control', () => {
  test('is this page\'s where the state names it as the holder', () => {
    const page = setUpOpen();
    assert.ok(!page.connection.steers);
    page.socket.says({ type: 'patch', revision: 6, patch: { control: { holder: 'a' } } });
    assert.ok(page.connection.steers);
    page.socket.ends(1006);
    assert.ok(!page.connection.steers);
  });
});

describe('a refusal', () => {
  test('of the token is final, and told with the error of the server', () => {
    const page = setUp();
    page.connection.start();
    page.socket.opens();
    const error = { type: 'error', code: 'not-allowed', message: 'The token is wrong.' };
    page.socket.says(error);
    page.socket.ends(1008, 'policy');
    assert.deepEqual(page.phase, { name: 'refused', reason: error });
    assert.equal(page.clock.next, undefined);
    assert.deepEqual(page.errors, []);
  });

  test('without an error is told by the reason of the close', () => {
    const page = setUp();
    page.connection.start();
    page.socket.ends(1008, 'policy');
    assert.deepEqual(page.phase, { name: 'refused', reason: { message: 'policy' } });
  });

  test('is tried again only when the page is seen again', () => {
    const page = setUp();
    page.connection.start();
    page.socket.ends(1008);
    page.connection.wake();
    assert.equal(page.sockets.length, 2);
  });

  test('for want of room is tried again', () => {
    const page = setUp();
    page.connection.start();
    page.socket.opens();
    page.socket.says({ type: 'error', code: 'too-many', message: 'The server has no room.' });
    page.socket.ends(1013);
    assert.equal(page.phase.name, 'waiting');
    assert.equal(page.phase.reason.message, 'The server has no room.');
    assert.equal(page.clock.next, 250);
  });
});

describe('a handshake that is refused', () => {
  test('is told about by an ordinary request, as long as it is', async () => {
    const page = setUp();
    page.answer = { status: 403, text: 'pages of this origin may not connect: start the server with it\n' };
    page.connection.start();
    page.socket.ends(1006);
    assert.equal(page.phase.reason, undefined);
    await settle();
    assert.deepEqual(page.asked, ['http://server/ws?origin=https://desk.example']);
    const told = { message: 'pages of this origin may not connect: start the server with it' };
    assert.deepEqual(page.phase.reason, told);
    page.clock.advance(250);
    page.socket.ends(1006);
    assert.deepEqual(page.phase.reason, told);
    await settle();
    page.answer = undefined; // the server is gone
    page.clock.advance(500);
    page.socket.ends(1006);
    await settle();
    assert.equal(page.phase.reason, undefined);
  });

  test('by a server that answers otherwise, or after an opened socket, is told nothing about', async () => {
    const page = setUp();
    page.answer = { status: 502, text: '<html>Bad gateway</html>' };
    page.connection.start();
    page.socket.ends(1006);
    await settle();
    assert.equal(page.phase.reason, undefined);
    page.clock.advance(250);
    page.socket.opens();
    page.socket.ends(1006);
    await settle();
    assert.equal(page.asked.length, 1);
  });

  test('in the meantime a new try is not told about the last one', async () => {
    const page = setUp();
    page.answer = { status: 426, text: 'WebSockets do not get through' };
    page.connection.start();
    page.socket.ends(1006);
    page.connection.wake();
    await settle();
    assert.equal(page.phase.name, 'connecting');
  });
});

test('the socket lies beside the page', () => {
  assert.equal(socketAddress('http://host:8080/#token=a'), 'ws://host:8080/ws');
  assert.equal(socketAddress('https://host/preview/index.html'), 'wss://host/preview/ws');
});

test('the token comes from the fragment, untouched but for its escapes', () => {
  assert.equal(tokenFrom(''), undefined);
  assert.equal(tokenFrom('#token='), undefined);
  assert.equal(tokenFrom('#token=a-b_c'), 'a-b_c');
  assert.equal(tokenFrom('#x=1&token=a+b%2Fc&y=2'), 'a+b/c');
  assert.equal(tokenFrom('#token=100%'), '100%');
});

test('the address asks for the role', () => {
  assert.equal(roleFrom(''), 'control');
  assert.equal(roleFrom('#token=watch'), 'control');
  assert.equal(roleFrom('#watch'), 'view');
  assert.equal(roleFrom('#watch&token=abc'), 'view');
  assert.equal(roleFrom('#token=abc&watch'), 'view');
});
