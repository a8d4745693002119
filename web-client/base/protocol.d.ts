// Written by tests/web/protocol-types.mjs from protocol/protocol.schema.json.

export type ClientControl = {
  action: 'take' | 'release' | 'ask' | 'cancel' | 'give' | 'decline';
  client?: string;
  id?: number;
  type: 'control';
};

export type ClientFit = {
  id?: number;
  node?: number;
  type: 'fit';
};

export type ClientFly = {
  easing?: 'smooth' | 'linear';
  id?: number;
  keyframes: Array<{
    at: number;
    camera: {
      center?: Array<number>;
      eye?: Array<number>;
      focus?: Array<number>;
      fov?: number;
      node?: number;
      up?: Array<number>;
    };
  }>;
  type: 'fly';
};

export type ClientFrame = {
  id?: number;
  shown?: number;
  type: 'frame';
};

export type ClientHello = {
  id?: number;
  name?: string;
  resume?: string;
  role: 'control' | 'view' | 'host';
  token?: string;
  type: 'hello';
};

export type ClientKeydown = {
  altKey?: boolean;
  code: string;
  ctrlKey?: boolean;
  id?: number;
  key: string;
  metaKey?: boolean;
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'keydown';
};

export type ClientKeyup = {
  altKey?: boolean;
  code: string;
  ctrlKey?: boolean;
  id?: number;
  key: string;
  metaKey?: boolean;
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'keyup';
};

export type ClientMessage = ClientHello | ClientResize | ClientFrame | ClientPointerdown | ClientPointermove | ClientPointerup | ClientPointercancel | ClientWheel | ClientKeydown | ClientKeyup | ClientNavigate | ClientFit | ClientSwing | ClientPatch | ClientPick | ClientSnapshot | ClientFly | ClientTree | ClientOpen | ClientScenes | ClientRecord | ClientControl | ClientShare | ClientShown;

export type ClientNavigate = {
  id?: number;
  pan?: Array<number>;
  rotate?: Array<number>;
  type: 'navigate';
  zoom?: number;
};

export type ClientOpen = {
  id?: number;
  scene: string;
  type: 'open';
};

export type ClientPatch = {
  id?: number;
  ifRevision?: number;
  patch: StatePatch;
  type: 'patch';
};

export type ClientPick = {
  frame?: number;
  id?: number;
  then?: 'select' | 'center' | 'lookAt';
  through?: boolean;
  type: 'pick';
  x: number;
  y: number;
};

export type ClientPointercancel = {
  altKey?: boolean;
  button: number;
  buttons: number;
  ctrlKey?: boolean;
  frame?: number;
  id?: number;
  metaKey?: boolean;
  pointerId: number;
  pointerType: 'mouse' | 'touch' | 'pen';
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'pointercancel';
  x: number;
  y: number;
};

export type ClientPointerdown = {
  altKey?: boolean;
  button: number;
  buttons: number;
  ctrlKey?: boolean;
  frame?: number;
  id?: number;
  metaKey?: boolean;
  pointerId: number;
  pointerType: 'mouse' | 'touch' | 'pen';
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'pointerdown';
  x: number;
  y: number;
};

export type ClientPointermove = {
  altKey?: boolean;
  button: number;
  buttons: number;
  ctrlKey?: boolean;
  frame?: number;
  id?: number;
  metaKey?: boolean;
  pointerId: number;
  pointerType: 'mouse' | 'touch' | 'pen';
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'pointermove';
  x: number;
  y: number;
};

export type ClientPointerup = {
  altKey?: boolean;
  button: number;
  buttons: number;
  ctrlKey?: boolean;
  frame?: number;
  id?: number;
  metaKey?: boolean;
  pointerId: number;
  pointerType: 'mouse' | 'touch' | 'pen';
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'pointerup';
  x: number;
  y: number;
};

export type ClientRecord = {
  action: 'start' | 'stop';
  id?: number;
  name?: string;
  type: 'record';
};

export type ClientResize = {
  height: number;
  id?: number;
  inset?: {
    bottom?: number;
    left?: number;
    right?: number;
    top?: number;
  };
  pixelRatio: number;
  type: 'resize';
  width: number;
};

export type ClientScenes = {
  id?: number;
  type: 'scenes';
};

export type ClientShare = {
  id?: number;
  page?: string;
  type: 'share';
};

export type ClientShown = {
  id?: number;
  revision: number;
  type: 'shown';
};

export type ClientSnapshot = {
  camera?: {
    center?: Array<number>;
    eye?: Array<number>;
    focus?: Array<number>;
    fov?: number;
    node?: number;
    up?: Array<number>;
  };
  format?: 'jpeg' | 'png';
  height: number;
  id?: number;
  jpegQuality?: number;
  renderer?: {
    mode?: 'realistic' | 'stylized';
    showSelection?: boolean;
    wireframe?: boolean;
  };
  type: 'snapshot';
  width: number;
};

export type ClientSwing = {
  id?: number;
  ms?: number;
  node: number;
  open?: number;
  type: 'swing';
};

export type ClientTree = {
  after?: number;
  depth?: number;
  id?: number;
  node?: number;
  only?: 'switches' | 'hinges';
  search?: string;
  type: 'tree';
};

export type ClientWheel = {
  altKey?: boolean;
  ctrlKey?: boolean;
  deltaMode: number;
  deltaX: number;
  deltaY: number;
  id?: number;
  metaKey?: boolean;
  shiftKey?: boolean;
  timeStamp?: number;
  type: 'wheel';
  x: number;
  y: number;
};

export type FrameHeader = {
  camera: {
    center: Array<number>;
    eye: Array<number>;
    far: number;
    focus: Array<number>;
    fov: number;
    name?: string;
    near: number;
    node?: number;
    projectionMatrix: Array<number>;
    up: Array<number>;
    viewMatrix: Array<number>;
  };
  frame: number;
  handled: number;
  height: number;
  markers?: Record<string, Array<number>>;
  quality: {
    detail: number;
    error?: number;
    jpegQuality: number;
    level: 'moving' | 'still';
    samples: number;
    scale: number;
    subsampling: '4:2:0' | '4:4:4';
  };
  renderer: {
    mode: 'realistic' | 'stylized';
    showSelection: boolean;
    wireframe: boolean;
  };
  revision: number;
  snapshot?: number;
  timing: {
    encodeMs: number;
    readbackMs: number;
    renderMs: number;
    sinceInputMs?: number;
  };
  view: {
    height: number;
    pixelRatio: number;
    width: number;
  };
  width: number;
};

export type ServerError = {
  code: 'bad-message' | 'out-of-range' | 'unknown-member' | 'read-only' | 'unknown-node' | 'unknown-frame' | 'stale-revision' | 'not-in-control' | 'not-allowed' | 'refused-scene' | 'busy' | 'too-many' | 'failed';
  id?: number;
  message: string;
  type: 'error';
};

export type ServerFlown = {
  completed: boolean;
  id: number;
  type: 'flown';
};

export type ServerLoading = {
  done?: boolean;
  fraction: number;
  refused?: string;
  scene: string;
  type: 'loading';
};

export type ServerMessage = ServerWelcome | ServerOk | ServerPicked | ServerFlown | ServerTree | ServerScenes | ServerShared | ServerLoading | ServerStats | ServerError | ServerState | ServerPatch;

export type ServerOk = {
  id: number;
  name?: string;
  revision: number;
  type: 'ok';
};

export type ServerPatch = {
  by?: string;
  patch: object;
  revision: number;
  type: 'patch';
};

export type ServerPicked = {
  distance?: number;
  id: number;
  local?: Array<number>;
  name?: string;
  node?: number;
  normal?: Array<number>;
  path?: Array<string>;
  point?: Array<number>;
  type: 'picked';
};

export type ServerScenes = {
  id: number;
  scenes: Array<string>;
  type: 'scenes';
};

export type ServerShared = {
  address: string;
  id: number;
  loopback: boolean;
  qr: Array<string>;
  type: 'shared';
};

export type ServerState = {
  revision: number;
  state: StateDocument;
  type: 'state';
};

export type ServerStats = {
  bytesPerSecond: number;
  clients: number;
  framesPerSecond: number;
  hosts: Record<string, {
    lagMs?: number;
    name: string;
    revision: number;
  }>;
  quality?: {
    detail: number;
    error?: number;
    jpegQuality: number;
    level: 'moving' | 'still';
    samples: number;
    scale: number;
    subsampling: '4:2:0' | '4:4:4';
  };
  renderer?: {
    meanRenderMs: number;
    medianRenderMs: number;
    p95RenderMs: number;
  };
  type: 'stats';
  watchers: number;
};

export type ServerTree = {
  id: number;
  next?: number;
  nodes: Array<{
    active: boolean;
    activeChild?: number;
    children: number;
    choices?: Array<string>;
    hinge?: {
      axis: Array<number>;
      closed: Array<number>;
      degrees: number;
    };
    id: number;
    material?: number;
    matrix?: Array<number>;
    name: string;
    parent?: number;
    triangles: number;
    type: string;
  }>;
  type: 'tree';
};

export type ServerWelcome = {
  client: string;
  id?: number;
  input: {
    dragZoom: number;
    drags: Record<string, Record<string, string>>;
    keys: Array<string>;
    repeatingKeys: Array<string>;
    wheelSteps: Array<number>;
    wheelZoom: number;
  };
  limits: {
    maxDepth: number;
    maxGrants: number;
    maxMessage: number;
    maxPixels: number;
    maxServerMessage: number;
    messagesPerSecond: number;
  };
  role: 'control' | 'view' | 'host';
  server: string;
  type: 'welcome';
  version: number;
};

export type StateDocument = {
  backgrounds: {
    active: string;
    color: Array<number>;
    items: Record<string, {
      color: Array<number>;
      name: string;
      texture?: string;
    }>;
  };
  camera: {
    center: Array<number>;
    eye: Array<number>;
    far: number;
    focus: Array<number>;
    fov: number;
    name?: string;
    near: number;
    node?: number;
    up: Array<number>;
  };
  cameras: Record<string, {
    name: string;
  }>;
  clients: Record<string, {
    name?: string;
    role: 'control' | 'view' | 'host';
  }>;
  control: {
    absent: boolean;
    asking: Array<{
      client: string;
      name?: string;
    }>;
    holder?: string;
    kept: boolean;
    name?: string;
  };
  lights: {
    active: string;
    items: Record<string, {
      attenuation: Array<number>;
      color: Array<number>;
      name: string;
      type: string;
    }>;
  };
  markers: Record<string, {
    node?: number;
    point: Array<number>;
    text: string;
  }>;
  materials: Record<string, {
    name: string;
  }>;
  navigation: {
    keepUpright: boolean;
    panSpeed: number;
    rotateSpeed: number;
    style: 'vrut' | 'maya' | 'catia' | 'cinema4d';
    tapSwings: boolean;
    turnAbout: 'center' | 'touched';
    zoomSpeed: number;
  };
  nodes: Record<string, {
    active?: boolean;
    activeChild?: number;
    material?: number;
    matrix?: Array<number>;
  }>;
  notices: Array<{
    code: 'scene' | 'software' | 'not-kept' | 'unusable-changes' | 'recording-ended' | 'not-drawn' | 'not-encoded' | 'no-memory' | 'smaller' | 'driver-restarted';
    message: string;
  }>;
  quality: {
    latencyTargetMs: number;
    preference: number;
  };
  recording?: {
    name: string;
  };
  renderer: {
    mode: 'realistic' | 'stylized';
    reflective: number;
    showSelection: boolean;
    solid: number;
    transparent: number;
    wireframe: boolean;
  };
  scene: {
    bounds: {
      max: Array<number>;
      min: Array<number>;
    };
    file: string;
    geometries: number;
    materials: number;
    name: string;
    nodes: number;
    notices: Array<{
      code: 'scene' | 'software' | 'not-kept' | 'unusable-changes' | 'recording-ended' | 'not-drawn' | 'not-encoded' | 'no-memory' | 'smaller' | 'driver-restarted';
      message: string;
    }>;
    triangles: number;
  };
  selection: {
    hinge?: number;
    name?: string;
    node?: number;
    path?: Array<string>;
    pathIds?: Array<number>;
  };
  swings: Record<string, {
    to: number;
  }>;
  views: Record<string, {
    center: Array<number>;
    eye: Array<number>;
    focus: Array<number>;
    fov: number;
    order?: number;
    up: Array<number>;
  }>;
};

export type StatePatch = {
  backgrounds?: null | {
    active?: null | string;
    color?: null | Array<number>;
    items?: null | Record<string, null | {
      color?: null | Array<number>;
    }>;
  };
  camera?: null | {
    center?: null | Array<number>;
    eye?: null | Array<number>;
    focus?: null | Array<number>;
    fov?: null | number;
    node?: null | number;
    up?: null | Array<number>;
  };
  lights?: null | {
    active?: null | string;
    items?: null | Record<string, null | {
      attenuation?: null | Array<number>;
      color?: null | Array<number>;
    }>;
  };
  markers?: null | Record<string, null | {
    node?: null | number;
    point?: null | Array<number>;
    text?: null | string;
  }>;
  navigation?: null | {
    keepUpright?: null | boolean;
    panSpeed?: null | number;
    rotateSpeed?: null | number;
    style?: null | 'vrut' | 'maya' | 'catia' | 'cinema4d';
    tapSwings?: null | boolean;
    turnAbout?: null | 'center' | 'touched';
    zoomSpeed?: null | number;
  };
  nodes?: null | Record<string, null | {
    active?: null | boolean;
    activeChild?: null | number;
    material?: null | number;
    matrix?: null | Array<number>;
  }>;
  quality?: null | {
    latencyTargetMs?: null | number;
    preference?: null | number;
  };
  renderer?: null | {
    mode?: null | 'realistic' | 'stylized';
    showSelection?: null | boolean;
    wireframe?: null | boolean;
  };
  selection?: null | {
    node?: null | number;
  };
  views?: null | Record<string, null | {
    center?: null | Array<number>;
    eye?: null | Array<number>;
    focus?: null | Array<number>;
    fov?: null | number;
    order?: null | number;
    up?: null | Array<number>;
  }>;
};
