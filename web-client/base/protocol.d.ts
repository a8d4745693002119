// Written by tests/web/protocol-types.mjs from protocol/protocol.schema.json.

export type Camera = {
  /** The centre of rotation. */
  center: Array<number>;
  /** Where the camera stands. */
  eye: Array<number>;
  /** Far end of a clip range for hosts' own drawing. */
  far: number;
  /** What it looks at. */
  focus: Array<number>;
  /** The vertical angle of view in degrees. */
  fov: number;
  /** Name of the camera node at which the camera stands. */
  name?: string;
  /** Near end of a clip range for hosts' own drawing; never below 10⁻⁶ of `far`. */
  near: number;
  /** The camera node at which the camera stands. */
  node?: number;
  /** Which way is up in the image; unit, at right angles to the view. */
  up: Array<number>;
};

export type CameraOverlay = {
  /** The centre of rotation. */
  center?: Array<number>;
  /** Where the camera stands. */
  eye?: Array<number>;
  /** What it looks at. */
  focus?: Array<number>;
  /** The vertical angle of view in degrees. */
  fov?: number;
  /** A camera node, whose pose is laid over first. */
  node?: number;
  /** Which way is up in the image. */
  up?: Array<number>;
};

export type ClientCheck = {
  /** A list of cues as in its file. */
  cues: CueList;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  type: 'check';
};

export type ClientControl = {
  /** What is to happen with control. */
  action: 'take' | 'release' | 'ask' | 'cancel' | 'give' | 'decline';
  /** Required with `give` and `decline`: the client that gets control, or does not. */
  client?: string;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  type: 'control';
};

export type ClientCue = {
  /** Laid over the camera of the cue, which does not change. */
  camera?: CameraOverlay;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** How long it takes to come to it; without it the cue's own time. */
  ms?: number;
  /** Which. Without `step`. */
  name?: string;
  /** How many after the one that was shown last, in their order. Without `name`. */
  step?: number;
  type: 'cue';
};

export type ClientFit = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** The node to fit, with all below it; without it the scene. */
  node?: number;
  type: 'fit';
};

export type ClientFly = {
  /** `smooth` eases the whole flight at its start and end; it does not stop at keyframes. */
  easing?: 'smooth' | 'linear';
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** The cameras to pass, the last of them exactly. */
  keyframes: Array<{
    /** Milliseconds from the start; they rise strictly. */
    at: number;
    /** Laid over the camera of the keyframe before, the first over the present one. */
    camera: CameraOverlay;
  }>;
  type: 'fly';
};

export type ClientFrame = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Number of the newest frame that the client has displayed: acknowledges it and all before it. */
  shown?: number;
  type: 'frame';
};

export type ClientHello = {
  /** Frames shall hold depth, by which the client draws them from another camera. */
  depth?: boolean;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** How others see the client; of two of the same name one gets a number, as "iPad 2". */
  name?: string;
  /** A secret of the client's own, by which it gets control back after a lost connection. */
  resume?: string;
  /** The role asked for; `welcome` tells the one given, which the token decides. */
  role: 'control' | 'view' | 'host';
  /** The control token or the view token, where the server has tokens. */
  token?: string;
  type: 'hello';
};

export type ClientKeydown = {
  /** Alt is held. */
  altKey?: boolean;
  /** Which key it is, as in W3C UI Events: `KeyF`, `ArrowLeft`. */
  code: string;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** What the key means, as in W3C UI Events: `f`, `ArrowLeft`. */
  key: string;
  /** Meta is held. */
  metaKey?: boolean;
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  type: 'keydown';
};

export type ClientKeyup = {
  /** Alt is held. */
  altKey?: boolean;
  /** Which key it is, as in W3C UI Events: `KeyF`, `ArrowLeft`. */
  code: string;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** What the key means, as in W3C UI Events: `f`, `ArrowLeft`. */
  key: string;
  /** Meta is held. */
  metaKey?: boolean;
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  type: 'keyup';
};

export type ClientMessage = ClientHello | ClientResize | ClientFrame | ClientPointerdown | ClientPointermove | ClientPointerup | ClientPointercancel | ClientWheel | ClientKeydown | ClientKeyup | ClientNavigate | ClientFit | ClientSwing | ClientPatch | ClientPick | ClientSnapshot | ClientFly | ClientCue | ClientCheck | ClientTree | ClientOpen | ClientScenes | ClientRecord | ClientControl | ClientShare | ClientShown | ClientPoint;

export type ClientNavigate = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** [right, down]: how far the image moves, in view heights, in the plane through `focus`. */
  pan?: Array<number>;
  /** [right, down] in degrees, as if dragged. */
  rotate?: Array<number>;
  type: 'navigate';
  /** Divides the distance from eye to focus. */
  zoom?: number;
};

export type ClientOpen = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** A name as in the answer to `scenes`. */
  scene: string;
  type: 'open';
  /** The up axis, for formats that do not define it; without it the last choice. */
  upAxis?: 'y' | 'z';
};

export type ClientPatch = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** The patch is refused where something that it names has changed since this revision. */
  ifRevision?: number;
  /** A merge patch (RFC 7396) on the state document. */
  patch: StatePatch;
  type: 'patch';
};

export type ClientPick = {
  /** The frame whose camera counts, one of the last 64 of the view; without it the present camera. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Find a corner, an edge or the like near by, too. */
  snap?: {
    /** What may be found; empty: all but `loop`. */
    to?: Array<'point' | 'vertex' | 'midpoint' | 'center' | 'edge' | 'loop' | 'plane'>;
    /** CSS pixels from the point of the view. */
    within: number;
  };
  /** Select the node, make the point the centre of rotation, or look at it, too. */
  then?: 'select' | 'center' | 'lookAt';
  /** Pass transparent parts; the realistic mode always passes those of alpha 0. */
  through?: boolean;
  type: 'pick';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type ClientPoint = {
  /** The frame whose camera counts, as of `pick`; without it the present camera. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  type: 'point';
  /** CSS pixels from the view's left edge. Without `y` it must be missing. */
  x?: number;
  /** CSS pixels from the view's top edge. Without `x` it must be missing. */
  y?: number;
};

export type ClientPointercancel = {
  /** Alt is held. */
  altKey?: boolean;
  /** The button that changed: −1 none, 0 left, 1 middle, 2 right. */
  button: number;
  /** The sum of the buttons that are down: 1 left, 2 right, 4 middle. */
  buttons: number;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Number of the frame that the user saw; without it the newest drawn counts. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Meta is held. */
  metaKey?: boolean;
  /** Tells one finger from another, as in W3C Pointer Events. */
  pointerId: number;
  /** What points. */
  pointerType: 'mouse' | 'touch' | 'pen';
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  /** With the first move of a drag: what the client's own picture shows there. */
  touched?: Array<number>;
  type: 'pointercancel';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type ClientPointerdown = {
  /** Alt is held. */
  altKey?: boolean;
  /** The button that changed: −1 none, 0 left, 1 middle, 2 right. */
  button: number;
  /** The sum of the buttons that are down: 1 left, 2 right, 4 middle. */
  buttons: number;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Number of the frame that the user saw; without it the newest drawn counts. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Meta is held. */
  metaKey?: boolean;
  /** Tells one finger from another, as in W3C Pointer Events. */
  pointerId: number;
  /** What points. */
  pointerType: 'mouse' | 'touch' | 'pen';
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  /** With the first move of a drag: what the client's own picture shows there. */
  touched?: Array<number>;
  type: 'pointerdown';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type ClientPointermove = {
  /** Alt is held. */
  altKey?: boolean;
  /** The button that changed: −1 none, 0 left, 1 middle, 2 right. */
  button: number;
  /** The sum of the buttons that are down: 1 left, 2 right, 4 middle. */
  buttons: number;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Number of the frame that the user saw; without it the newest drawn counts. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Meta is held. */
  metaKey?: boolean;
  /** Tells one finger from another, as in W3C Pointer Events. */
  pointerId: number;
  /** What points. */
  pointerType: 'mouse' | 'touch' | 'pen';
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  /** With the first move of a drag: what the client's own picture shows there. */
  touched?: Array<number>;
  type: 'pointermove';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type ClientPointerup = {
  /** Alt is held. */
  altKey?: boolean;
  /** The button that changed: −1 none, 0 left, 1 middle, 2 right. */
  button: number;
  /** The sum of the buttons that are down: 1 left, 2 right, 4 middle. */
  buttons: number;
  /** Control is held. */
  ctrlKey?: boolean;
  /** Number of the frame that the user saw; without it the newest drawn counts. */
  frame?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Meta is held. */
  metaKey?: boolean;
  /** Tells one finger from another, as in W3C Pointer Events. */
  pointerId: number;
  /** What points. */
  pointerType: 'mouse' | 'touch' | 'pen';
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  /** With the first move of a drag: what the client's own picture shows there. */
  touched?: Array<number>;
  type: 'pointerup';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type ClientRecord = {
  /** Begin or end the log. */
  action: 'start' | 'stop';
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Of the log: A to Z, a to z, 0 to 9, `_`, `-`. Without it a name is made of the time. */
  name?: string;
  type: 'record';
};

export type ClientResize = {
  /** CSS pixels; fractions are allowed. */
  height: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** What lies on the view's sides and covers it, in CSS pixels. */
  inset?: {
    /** Covered at the bottom. */
    bottom?: number;
    /** Covered at the left. */
    left?: number;
    /** Covered at the right. */
    right?: number;
    /** Covered at the top. */
    top?: number;
  };
  /** Pixels of the image to a CSS pixel. */
  pixelRatio: number;
  type: 'resize';
  /** CSS pixels; fractions are allowed. */
  width: number;
};

export type ClientScenes = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  type: 'scenes';
};

export type ClientShare = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Where the client has opened the page: an address of HTTP without query and fragment. */
  page?: string;
  type: 'share';
};

export type ClientShown = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** What the host's walls show now. */
  revision: number;
  type: 'shown';
};

export type ClientSnapshot = {
  /** Laid over the shared camera, which does not change. */
  camera?: CameraOverlay;
  /** The scene as this cue shows it; it is not shown to others. */
  cue?: string;
  /** Of the file. */
  format?: 'jpeg' | 'png';
  /** Pixels. */
  height: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Of a JPEG file. */
  jpegQuality?: number;
  /** Laid over the shared renderer, which does not change. */
  renderer?: {
    /** How surfaces are drawn. */
    mode?: 'realistic' | 'stylized';
    /** Bring out what is selected. */
    showSelection?: boolean;
    /** Edges only. */
    wireframe?: boolean;
  };
  /** A pixel; without it as many as at full accuracy. */
  samples?: number;
  type: 'snapshot';
  /** Pixels. */
  width: number;
};

export type ClientSwing = {
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** The time from one end to the other. */
  ms?: number;
  /** A node with a hinge, or one below it. */
  node: number;
  /** 0 closed, 1 open; without it closed, or open where it is closed already. */
  open?: number;
  type: 'swing';
};

export type ClientTree = {
  /** What the page before had as `next`. */
  after?: number;
  /** Levels below the node; without it 1, or all with `search` or `only`. */
  depth?: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Where to begin; without it at the root. */
  node?: number;
  /** Only switches, or only what has a hinge. */
  only?: 'switches' | 'hinges';
  /** Only nodes whose name has this part; A to Z count in either case. */
  search?: string;
  type: 'tree';
};

export type ClientWheel = {
  /** Alt is held. */
  altKey?: boolean;
  /** Control is held. */
  ctrlKey?: boolean;
  /** The unit: 0 pixels, 1 lines, 2 pages. */
  deltaMode: number;
  /** Sideways; without effect. */
  deltaX: number;
  /** Towards the user, in the unit of `deltaMode`. */
  deltaY: number;
  /** Asks for exactly one answer, which has the same `id`. It rises. */
  id?: number;
  /** Meta is held. */
  metaKey?: boolean;
  /** Shift is held. */
  shiftKey?: boolean;
  /** When it happened, in milliseconds of the client's own clock. */
  timeStamp?: number;
  /** What the client's own picture shows there. */
  touched?: Array<number>;
  type: 'wheel';
  /** CSS pixels from the view's left edge. */
  x: number;
  /** CSS pixels from the view's top edge. */
  y: number;
};

export type CueList = {
  /** As the state's `cues`. */
  cues: Cues;
  /** What the file is. */
  format: 'vrut-preview-cues';
  /** Name of the scene's file; missing: any. */
  scene?: string;
  /** Of this format. */
  version: number;
};

export type Cues = Record<string, null | {
  backgrounds?: null | {
    active?: null | string;
    color?: null | Array<number>;
  };
  camera?: null | {
    center?: null | Array<number>;
    eye?: null | Array<number>;
    focus?: null | Array<number>;
    fov?: null | number;
    up?: null | Array<number>;
  };
  easing?: null | 'smooth' | 'linear';
  lights?: null | {
    active?: null | string;
  };
  ms?: null | number;
  nodes?: null | Record<string, null | {
    active?: null | boolean;
    activeChild?: null | number;
    material?: null | number;
    matrix?: null | Array<number>;
  }>;
  order?: null | number;
  sectionBox?: null | {
    caps?: null | boolean;
    hatched?: null | boolean;
    max?: null | Array<number>;
    min?: null | Array<number>;
    on?: null | boolean;
  };
  sections?: null | Record<string, null | {
    caps?: null | boolean;
    distance?: null | number;
    hatched?: null | boolean;
    normal?: null | Array<number>;
    on?: null | boolean;
  }>;
  selection?: null | {
    node?: null | number;
  };
  text?: null | string;
}>;

export type EventLogConnected = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  /** Who came. */
  client: string;
  event: 'connected';
  /** As in its `hello`. */
  name?: string;
  /** As in its `hello`; only in a shared room's log. */
  resume?: string;
  /** The role given. */
  role: 'control' | 'view' | 'host';
};

export type EventLogControl = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  /** Who holds control from here on; missing: nobody. */
  client?: string;
  event: 'control';
};

export type EventLogDisconnected = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  /** Who left. */
  client: string;
  event: 'disconnected';
};

export type EventLogDrawn = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  event: 'drawn';
  /** Number of the frame. */
  frame: number;
};

export type EventLogHeader = {
  /** Nobody had moved the camera yet. */
  atHome?: boolean;
  /** Who was connected; a size only where the client had asked for one. */
  clients: Array<{
    /** The client's id. */
    client: string;
    /** CSS pixels; fractions are allowed. */
    height?: number;
    /** What lies on the view's sides and covers it, in CSS pixels. */
    inset?: {
      /** Covered at the bottom. */
      bottom?: number;
      /** Covered at the left. */
      left?: number;
      /** Covered at the right. */
      right?: number;
      /** Covered at the top. */
      top?: number;
    };
    /** As in its `hello`. */
    name?: string;
    /** Pixels of the image to a CSS pixel. */
    pixelRatio?: number;
    /** As in its `hello`; only in a shared room's log. */
    resume?: string;
    /** The role given. */
    role: 'control' | 'view' | 'host';
    /** Of its last message; only in a shared room's log. */
    sequence?: number;
    /** CSS pixels; fractions are allowed. */
    width?: number;
  }>;
  /** The flight that was going on. */
  flight?: {
    /** Who sent the `fly`. */
    client: string;
    /** Its `keyframes` and `easing`. */
    fly: {
      /** `smooth` eases the whole flight at its start and end; it does not stop at keyframes. */
      easing?: 'smooth' | 'linear';
      /** The cameras to pass, the last of them exactly. */
      keyframes: Array<{
        /** Milliseconds from the start; they rise strictly. */
        at: number;
        /** Laid over the camera of the keyframe before, the first over the present one. */
        camera: CameraOverlay;
      }>;
    };
    /** Where it began. */
    from: Camera;
    /** Of the `fly`; 0: none. */
    id: number;
    /** Milliseconds that it had lasted. */
    since: number;
  };
  /** Frames that clients may still name. */
  frames?: Array<{
    /** The camera through which it was drawn. */
    camera: Camera;
    /** Number of the frame. */
    frame: number;
    /** The size of the view that it shows. */
    view: View;
  }>;
  /** The view "home" as it was at loading, which depends on the view's size then. */
  home?: {
    /** The centre of rotation. */
    center: Array<number>;
    /** Where the camera stands. */
    eye: Array<number>;
    /** What it looks at. */
    focus: Array<number>;
    /** The vertical angle of view in degrees. */
    fov: number;
    /** For clients to sort by: the lowest first, then those without one, by name. */
    order?: number;
    /** Which way is up in the image; unit, at right angles to the view. */
    up: Array<number>;
  };
  /** Tells that the file is an event log. */
  log: 'vrut-preview';
  /** Of the state; only in a shared room's log. */
  revision?: number;
  /** Name of the scene that is shown. */
  scene: string;
  /** SHA-256 of the scene's file. */
  sceneSha256: string;
  /** When the log began, by ISO 8601. */
  started: string;
  /** The state document. */
  state: StateDocument;
  /** The up axis in use; only for formats that do not define it. */
  upAxis?: 'y' | 'z';
  /** Of the protocol. */
  version: 1;
  /** The size in force. */
  view: View;
  /** The camera of hosts, where that was on its way. */
  walls?: {
    /** Where it was. */
    camera: {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** For clients to sort by: the lowest first, then those without one, by name. */
      order?: number;
      /** Which way is up in the image; unit, at right angles to the view. */
      up: Array<number>;
    };
    /** Milliseconds until its next step. */
    due: number;
    /** What it followed, on the way to the room's camera at the speeds allowed. */
    guide: {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** For clients to sort by: the lowest first, then those without one, by name. */
      order?: number;
      /** Which way is up in the image; unit, at right angles to the view. */
      up: Array<number>;
    };
    /** Of the view, about an axis of the world, in radians a second. */
    spin: Array<number>;
    /** Of the eye, in scene units a second. */
    velocity: Array<number>;
  };
};

export type EventLogLine = EventLogMessage | EventLogConnected | EventLogDisconnected | EventLogControl | EventLogOpened | EventLogDrawn | EventLogRevised;

export type EventLogMessage = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  /** Who sent it. */
  client: string;
  /** As it came. */
  message: ClientMessage;
};

export type EventLogOpened = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  /** What was kept of the scene: a patch with `views`, `markers` and `nodes`. */
  changes?: StatePatch;
  event: 'opened';
  /** Name of the scene. */
  scene: string;
  /** SHA-256 of the scene's file. */
  sceneSha256: string;
  /** The up axis in use; only for formats that do not define it. */
  upAxis?: 'y' | 'z';
};

export type EventLogRevised = {
  /** Milliseconds since the log began, in whole microseconds. */
  at: number;
  event: 'revised';
  /** The server's; missing: unchanged. */
  notices?: Array<Notice>;
  /** The event log that is being recorded, empty: none; missing: unchanged. */
  recording?: string;
  /** Of the state. */
  revision: number;
};

export type Feature = {
  /** The node whose surface it is on. */
  node: number;
  /** Of the node's own space: one, and for the last four kinds two more. */
  points: Array<Array<number>>;
  /** What it is. */
  snap: 'point' | 'vertex' | 'midpoint' | 'center' | 'edge' | 'loop' | 'plane';
};

export type FrameHeader = {
  /** The state's camera, with matrices. */
  camera: {
    /** The centre of rotation. */
    center: Array<number>;
    /** Where the camera stands. */
    eye: Array<number>;
    /** Far end of a clip range for hosts' own drawing. */
    far: number;
    /** What it looks at. */
    focus: Array<number>;
    /** The vertical angle of view in degrees. */
    fov: number;
    /** Name of the camera node at which the camera stands. */
    name?: string;
    /** Near end of a clip range for hosts' own drawing; never below 10⁻⁶ of `far`. */
    near: number;
    /** The camera node at which the camera stands. */
    node?: number;
    /** From the camera's space to clip space. */
    projectionMatrix: Array<number>;
    /** Which way is up in the image; unit, at right angles to the view. */
    up: Array<number>;
    /** From the world to the camera's space. */
    viewMatrix: Array<number>;
  };
  /** How far away is what it shows, for clients that asked for it. */
  depth?: {
    /** What is infinitely far turns with the camera; else it stays where it is in the image. */
    backgroundTurns: boolean;
    /** Of the map behind this file; 0: this client has it already. */
    bytes: number;
    /** Where image and map were drawn from; missing: from the header's `camera`. */
    camera?: {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** Which way is up in the image. */
      up: Array<number>;
    };
    /** Blocks in a row. */
    columns: number;
    /** The frame that the map was made for. */
    frame: number;
    /** Rows of blocks. */
    rows: number;
    /** Reciprocal distance of the nearest surface along the view. */
    scale: number;
  };
  /** Number of the frame; it rises. */
  frame: number;
  /** Highest `id` of this client that was handled when the state was taken; 0 before the first. */
  handled: number;
  /** Pixels of this file. */
  height: number;
  /** Of the server that drew it, where several share the room: it rises with each that takes over. */
  lease?: number;
  /** Where the markers' signs stand in the world, by name. */
  markers?: Record<string, Array<number>>;
  /** With what accuracy. */
  quality: Quality;
  /** How it was drawn. */
  renderer: {
    /** How surfaces were drawn. */
    mode: 'realistic' | 'stylized';
    /** What is selected was brought out. */
    showSelection: boolean;
    /** Edges only. */
    wireframe: boolean;
  };
  /** Of the state that it shows. */
  revision: number;
  /** The `id` of the `snapshot` that asked for it. */
  snapshot?: number;
  /** Milliseconds that were spent. */
  timing: {
    /** Encoding the file. */
    encodeMs: number;
    /** Reading the pixels back. */
    readbackMs: number;
    /** Drawing. */
    renderMs: number;
    /** From the arrival of the newest input that it shows to its hand-over to the socket. */
    sinceInputMs?: number;
  };
  /** The size of the view in force. */
  view: {
    /** CSS pixels; fractions are allowed. */
    height: number;
    /** Pixels of the image to a CSS pixel. */
    pixelRatio: number;
    /** CSS pixels; fractions are allowed. */
    width: number;
  };
  /** Pixels of this file. */
  width: number;
};

export type LevelTable = {
  /** Of the frames measured, at scale 1. */
  height: number;
  /** By rising accuracy. */
  levels: Array<{
    /** Median of the files. */
    bytes: number;
    /** Median of drawing, reading back and encoding. */
    ms: number;
    /** As frame headers tell it. One with `level` `still` tells the `error` at rest. */
    quality: Quality;
    /** Why it is in the table: a sentence. */
    reason?: string;
  }>;
  /** What draws, as the server's log tells it. */
  renderer: string;
  /** SHA-256 of the scene's file. */
  scene: string;
  /** Of the frames measured, at scale 1. */
  width: number;
};

export type Notice = {
  /** For programs. */
  code: 'scene' | 'software' | 'not-kept' | 'unusable-changes' | 'recording-ended' | 'not-drawn' | 'not-encoded' | 'no-memory' | 'smaller' | 'driver-restarted';
  /** A sentence for a person. */
  message: string;
};

export type Quality = {
  /** Pixels of error allowed in the meshes; 0 draws every triangle. */
  detail: number;
  /** Mean FLIP against full accuracy, 0 none, as measured for the level; missing where unknown. */
  error?: number;
  /** Of the JPEG file. */
  jpegQuality: number;
  /** `moving` while things change, `still` at rest. */
  level: 'moving' | 'still';
  /** To a pixel. */
  samples: number;
  /** By which the frame is drawn smaller than the view. */
  scale: number;
  /** Of the colours in the JPEG file. */
  subsampling: '4:2:0' | '4:4:4';
};

export type RenderJob = {
  /** The whole camera. */
  camera: CameraOverlay;
  /** By how many pixels surfaces may lie off. */
  detail: number;
  /** Of the image's file. */
  format: 'jpeg' | 'png';
  /** Pixels. */
  height: number;
  /** Its number in the film. */
  image: number;
  /** Of a JPEG file. */
  jpegQuality: number;
  /** Merge patches of the state, as text. */
  patches: Array<string>;
  /** By which the images of one film are known. */
  run: string;
  /** A pixel. */
  samples: number;
  /** The scene's name in the workers' folder of scenes. */
  scene: string;
  /** SHA-256 of all that the scene shows. */
  sha256: string;
  /** Whether the scene is shown in a studio. */
  studio: 'automatic' | 'on' | 'off';
  /** Of a file that does not define it. */
  upAxis: 'y' | 'z';
  /** Pixels. */
  width: number;
};

export type ServerChecked = {
  /** Names of the cues that do. */
  fitting: Array<string>;
  /** Of the `check`. */
  id: number;
  /** What does not go with the scene; empty: all of it does. */
  problems: Array<{
    /** The cue; missing: it is the whole list. */
    cue?: string;
    /** What is wrong, a sentence. */
    message: string;
  }>;
  type: 'checked';
};

export type ServerError = {
  /** For programs. */
  code: 'bad-message' | 'out-of-range' | 'unknown-member' | 'read-only' | 'unknown-node' | 'unknown-cue' | 'unknown-frame' | 'stale-revision' | 'not-in-control' | 'not-allowed' | 'refused-scene' | 'busy' | 'too-many' | 'failed';
  /** Of the message, where it could be read. */
  id?: number;
  /** One sentence for a person, which names the culprit. */
  message: string;
  type: 'error';
};

export type ServerFlown = {
  /** False where the flight was stopped. */
  completed: boolean;
  /** Of the `fly`. */
  id: number;
  type: 'flown';
};

export type ServerLoading = {
  /** Once, at the end: the scene is ready. */
  done?: boolean;
  /** How much of it is loaded. */
  fraction: number;
  /** Once, at the end: a sentence that tells why the scene is not shown. */
  refused?: string;
  /** Name of the scene that is loaded. */
  scene: string;
  type: 'loading';
};

export type ServerMessage = ServerWelcome | ServerOk | ServerPicked | ServerPointed | ServerFlown | ServerTree | ServerChecked | ServerScenes | ServerShared | ServerLoading | ServerStats | ServerError | ServerState | ServerPatch;

export type ServerOk = {
  /** Of the message. */
  id: number;
  /** Of the event log. */
  name?: string;
  /** Of the state that the message led to. */
  revision: number;
  type: 'ok';
};

export type ServerPatch = {
  /** The client whose doing it is; missing: the server's, or several clients'. */
  by?: string;
  /** From the document that this client got last to the present one. */
  patch: object;
  /** Of the state, once this is in it. */
  revision: number;
  type: 'patch';
};

export type ServerPicked = {
  /** From the eye. */
  distance?: number;
  /** Of the `pick`. */
  id: number;
  /** The point in the node's own space, for a marker that moves with it; none of a flattened node. */
  local?: Array<number>;
  /** Of the node. */
  name?: string;
  /** The node that was hit. */
  node?: number;
  /** Of the face, unit, towards the viewer. */
  normal?: Array<number>;
  /** Names from the root to the node that was hit, the last 32. */
  path?: Array<string>;
  /** In the world. */
  point?: Array<number>;
  /** What `snap` has found, if anything. */
  snapped?: {
    /** To be one of the `picks` of a measure. */
    feature: Feature;
    /** Of an edge, a circle or a loop, in the world; else empty. */
    line: Array<Array<number>>;
    /** Its first point, in the world. */
    point: Array<number>;
  };
  type: 'picked';
};

export type ServerPointed = {
  /** Who points. */
  client: string;
  /** As others see that client, where it has a name. */
  name?: string;
  /** Of the face, unit, towards who points; with `point`. */
  normal?: Array<number>;
  /** In the world; missing: that client points at nothing any more. */
  point?: Array<number>;
  type: 'pointed';
};

export type ServerScenes = {
  /** Of the `scenes`. */
  id: number;
  /** Names for `open`, sorted by their bytes. */
  scenes: Array<string>;
  type: 'scenes';
};

export type ServerShared = {
  /** Of the page, to watch only, with the view token where there is one. */
  address: string;
  /** Of the `share`. */
  id: number;
  /** True where no other machine reaches the address. */
  loopback: boolean;
  /** The address as a QR code: rows of 0, light, and 1, dark, without the quiet zone. */
  qr: Array<string>;
  type: 'shared';
};

export type ServerState = {
  /** Of the state, once this is in it. */
  revision: number;
  /** The whole document. */
  state: StateDocument;
  type: 'state';
};

export type ServerStats = {
  /** Sent to all clients. */
  bytesPerSecond: number;
  /** Clients that are connected. */
  clients: number;
  /** Sent to all clients. */
  framesPerSecond: number;
  /** By the client's id. */
  hosts: Record<string, {
    /** From that revision's making to the host's report, by the server's clock. */
    lagMs?: number;
    /** As in its `hello`. */
    name: string;
    /** What its walls show. */
    revision: number;
  }>;
  /** Of the newest frame; none before the first. */
  quality?: Quality;
  /** Times of drawing; none before the first frame. */
  renderer?: {
    /** Mean of the last 100 frames. */
    meanRenderMs: number;
    /** Median of the last 100 frames. */
    medianRenderMs: number;
    /** 95 of 100 took no longer, of the last 100 frames. */
    p95RenderMs: number;
  };
  type: 'stats';
  /** Clients of the role `view`. */
  watchers: number;
};

export type ServerTree = {
  /** Of the `tree`. */
  id: number;
  /** There is more: send it as `after`. */
  next?: number;
  /** Depth first, children by rising id. */
  nodes: Array<{
    /** False where it is hidden, with all below it. */
    active: boolean;
    /** Of a switch, as in the file: counted from 0, −1 none, −2 all. */
    activeChild?: number;
    /** Number of children. */
    children: number;
    /** The children's names, of a switch with at most 64 of them and 16 KiB of names. */
    choices?: Array<string>;
    /** What a door turns about. */
    hinge?: {
      /** Unit, in the node's own space, through its origin. */
      axis: Array<number>;
      /** The node's matrix as in the file. */
      closed: Array<number>;
      /** How far it opens; the sign tells which way. */
      degrees: number;
    };
    /** The node's id. */
    id: number;
    /** Id of its geometry's material. */
    material?: number;
    /** As it is now; where it is missing, the identity. */
    matrix?: Array<number>;
    /** The node's name. */
    name: string;
    /** The parent's id; none of the root. */
    parent?: number;
    /** Number of triangles of its own geometry. */
    triangles: number;
    /** `assembly`, `root`, `camera`, `geometry`, `light`, `lod`, `switch`, `background` or `sound`. */
    type: string;
  }>;
  type: 'tree';
};

export type ServerWelcome = {
  /** This client's id. */
  client: string;
  /** Of the `hello`, where it had one. */
  id?: number;
  /** What a client needs to foretell what input does, or to pass on what has a meaning only. */
  input: {
    /** A zooming drag upwards over the view's height divides the distance by it. */
    dragZoom: number;
    /** By style, by `buttons`: `rotate`, `pan`, `zoom`. Styles that use keys are left out. */
    drags: Record<string, Record<string, string>>;
    /** The `key` of each key that has a meaning. */
    keys: Array<string>;
    /** Of `keys`, those that go on while they are held. */
    repeatingKeys: Array<string>;
    /** [pixels, lines, pages] that make one step of the wheel. */
    wheelSteps: Array<number>;
    /** A step away from the user divides the distance by it. */
    wheelZoom: number;
  };
  /** What holds for messages and images. */
  limits: {
    /** Levels of nesting in a client's message. */
    maxDepth: number;
    /** Grants that the server keeps of a client. */
    maxGrants: number;
    /** Bytes of a client's message. */
    maxMessage: number;
    /** Pixels of an image; a larger view is drawn smaller. */
    maxPixels: number;
    /** Bytes of a server's message. */
    maxServerMessage: number;
    /** What a client sends faster is read more slowly. */
    messagesPerSecond: number;
  };
  /** The role given. */
  role: 'control' | 'view' | 'host';
  /** Version of the program. */
  server: string;
  type: 'welcome';
  /** Of this protocol. */
  version: number;
};

export type StateDocument = {
  /** The backgrounds, of which one is shown. */
  backgrounds: {
    /** Key of the item that is shown, or `color`: the plain one. */
    active: string;
    /** Red, green, blue, alpha of the plain background. */
    color: Array<number>;
    /** By the id of the background. */
    items: Record<string, {
      /** Red, green, blue, alpha. */
      color: Array<number>;
      /** As in the file. */
      name: string;
      /** File of its texture. */
      texture?: string;
    }>;
  };
  /** The one camera of all. */
  camera: Camera;
  /** Camera nodes, by id. */
  cameras: Record<string, {
    /** As in the file. */
    name: string;
  }>;
  /** Who is connected, by the client's id. */
  clients: Record<string, {
    /** As in `hello`, with its number. */
    name?: string;
    /** The role given. */
    role: 'control' | 'view' | 'host';
  }>;
  /** How fast the camera of hosts moves. */
  comfort: {
    /** How fast the view turns at most. */
    degreesPerSecond: number;
    /** How fast that speed changes at most. */
    degreesPerSecondSquared: number;
    /** How fast the eye moves at most, by the scene's unit. */
    metresPerSecond: number;
    /** How fast that speed changes at most. */
    metresPerSecondSquared: number;
    /** The camera of hosts keeps to these limits. */
    on: boolean;
  };
  /** Who holds control, and who asks. */
  control: {
    /** The holder has lost its connection, and may come back. */
    absent: boolean;
    /** Who asks for control, the first one first. */
    asking: Array<{
      /** The client's id. */
      client: string;
      /** As in its `hello`. */
      name?: string;
    }>;
    /** Id of the client that holds control. */
    holder?: string;
    /** True while there is a holder. */
    kept: boolean;
    /** As in the holder's `hello`. */
    name?: string;
  };
  /** The cue that was shown last. */
  cue?: {
    /** Its name among the `cues`. */
    name: string;
  };
  /** What a presentation shows, by name. */
  cues: Record<string, {
    /** What stands behind the scene. */
    backgrounds: {
      /** Key of the background that is shown, or `color`: the plain one. */
      active: string;
      /** Red, green, blue, alpha of the plain background. */
      color: Array<number>;
    };
    /** Where the camera flies to. */
    camera: {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** Which way is up in the image; unit, at right angles to the view. */
      up: Array<number>;
    };
    /** As of `fly`. */
    easing: 'smooth' | 'linear';
    /** Which light shines. */
    lights: {
      /** Key of the light that shines. */
      active: string;
    };
    /** How long it takes to come to it, in milliseconds. */
    ms: number;
    /** By id: all that differs from the file. */
    nodes: Record<string, {
      /** False hides the node, with all below it. */
      active?: boolean;
      /** Of a switch: counted from 0, −1 none, −2 all. */
      activeChild?: number;
      /** Id of the material of its geometry. */
      material?: number;
      /** From the node's space to its parent's; the last row is 0 0 0 1. */
      matrix?: Array<number>;
    }>;
    /** Cues follow each other by it: the lowest first, then those without one, by name. */
    order?: number;
    /** A box that cuts the scene open. */
    sectionBox: {
      /** Watertight parts are closed where it cuts them. */
      caps: boolean;
      /** The caps have lines across. */
      hatched: boolean;
      /** Its highest corner; at the start around the scene. */
      max: Array<number>;
      /** Its lowest corner; below `max` in each direction. */
      min: Array<number>;
      /** True: nothing outside of the box is shown. */
      on: boolean;
    };
    /** All planes that cut the scene open, by name. */
    sections: Record<string, {
      /** Watertight parts are closed where it cuts them. */
      caps: boolean;
      /** Of the plane from the world's origin, along `normal`. */
      distance: number;
      /** The caps have lines across. */
      hatched: boolean;
      /** Where it leads is cut away; unit, of any length but 0 in a patch. A new plane must have it. */
      normal: Array<number>;
      /** False: it cuts nothing. */
      on: boolean;
    }>;
    /** What is selected. */
    selection: {
      /** The node that is selected. */
      node?: number;
    };
    /** For who speaks. */
    text: string;
  }>;
  /** The lights, of which one shines. */
  lights: {
    /** Key of the item that shines; at the start `headlight`. */
    active: string;
    /** By the node's id, or `headlight`. */
    items: Record<string, {
      /** [constant, linear, quadratic]. */
      attenuation: Array<number>;
      /** Red, green, blue, alpha; above 1 is brighter than white. */
      color: Array<number>;
      /** As in the file. */
      name: string;
      /** `point`, `directional` or `spot`. */
      type: string;
    }>;
  };
  /** Notes on points of the scene, by name. */
  markers: Record<string, {
    /** Who made it. Of a new marker without one: the client's name, if it has one. */
    author?: string;
    /** What it asks for is done. */
    done: boolean;
    /** The marker moves with this node. */
    node?: number;
    /** In the world, or in the space of `node`. A new marker must have it. */
    point: Array<number>;
    /** For clients to show; a frame has the sign only. */
    text: string;
    /** When it was made, in milliseconds since 1970 in UTC, by the clock of its client. */
    time?: number;
    /** The camera that it was made from. Of a new marker without one: the present camera. */
    view?: {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** Which way is up in the image; unit, at right angles to the view. */
      up: Array<number>;
    };
  }>;
  /** Materials, by id. */
  materials: Record<string, {
    /** As in the file. */
    name: string;
  }>;
  /** What `measures` come to as the parts stand now, by name. */
  measured: Record<string, {
    /** Of a distance: the way from the first pick to the second, in the world. */
    components?: Array<number>;
    /** To be drawn, in the world; empty where a part is not shown. */
    line: Array<Array<number>>;
    /** Why there is no value, if there is none. */
    problem?: string;
    /** In the scene's unit, or degrees. */
    value?: number;
  }>;
  /** Distances, angles and the like, by name. */
  measures: Record<string, {
    /** What is measured. */
    kind: 'distance' | 'parallel' | 'angle' | 'radius' | 'length';
    /** Where. A new measure must have them. */
    picks: Array<Feature>;
  }>;
  /** What input does. */
  navigation: {
    /** Turn about the scene's vertical, and stop at the poles. */
    keepUpright: boolean;
    /** Multiplies pans by input. */
    panSpeed: number;
    /** Multiplies turns by input. */
    rotateSpeed: number;
    /** Which buttons and keys do what. */
    style: 'vrut' | 'maya' | 'catia' | 'cinema4d';
    /** A tap opens or closes what turns about a hinge. */
    tapSwings: boolean;
    /** What a drag turns about: the camera's `center`, or the surface point that was touched. */
    turnAbout: 'center' | 'touched';
    /** Multiplies zooms by input. */
    zoomSpeed: number;
  };
  /** By id: only what differs from the file. */
  nodes: Record<string, {
    /** False hides the node, with all below it. */
    active?: boolean;
    /** Of a switch: counted from 0, −1 none, −2 all. */
    activeChild?: number;
    /** Id of the material of its geometry. */
    material?: number;
    /** From the node's space to its parent's; the last row is 0 0 0 1. */
    matrix?: Array<number>;
  }>;
  /** What has gone wrong in the server, the newest last. */
  notices: Array<Notice>;
  /** Who may point. */
  pointing: {
    /** Clients of the roles `view` and `host` may point, too. */
    watchers: boolean;
  };
  /** How frames are drawn while things move. */
  quality: {
    /** How old a frame may be when the holder sees it, while things move. */
    latencyTargetMs: number;
    /** 0 speed, 1 accuracy. */
    preference: number;
  };
  /** The event log that is written now. */
  recording?: {
    /** Of the event log. */
    name: string;
  };
  /** How the scene is drawn. */
  renderer: {
    /** How surfaces are drawn. */
    mode: 'realistic' | 'stylized';
    /** Geometry nodes that reflect. */
    reflective: number;
    /** Bring out what is selected. */
    showSelection: boolean;
    /** Geometry nodes that are opaque. */
    solid: number;
    /** Geometry nodes that are transparent. */
    transparent: number;
    /** Edges only. */
    wireframe: boolean;
  };
  /** The scene as in the file. */
  scene: {
    /** The scene's box in the world. */
    bounds: {
      /** The greatest coordinates. */
      max: Array<number>;
      /** The least coordinates. */
      min: Array<number>;
    };
    /** The name by which `open` takes it. */
    file: string;
    /** Number of geometries. */
    geometries: number;
    /** Number of materials. */
    materials: number;
    /** The scene's title. */
    name: string;
    /** Number of nodes. */
    nodes: number;
    /** What to know of it, as what of the file is not shown. */
    notices: Array<Notice>;
    /** Where drags that rotate turn the view about the eye. */
    seats: Array<{
      /** The middle of where the eye is then. */
      eye: Array<number>;
      /** How far from it the eye may be. */
      radius: number;
    }>;
    /** Number of triangles. */
    triangles: number;
    /** The up axis in use; only for formats that do not define it: OBJ, STL and PLY. */
    upAxis?: 'y' | 'z';
  };
  /** A box that cuts the scene open. */
  sectionBox: {
    /** Watertight parts are closed where it cuts them. */
    caps: boolean;
    /** The caps have lines across. */
    hatched: boolean;
    /** Its highest corner; at the start around the scene. */
    max: Array<number>;
    /** Its lowest corner; below `max` in each direction. */
    min: Array<number>;
    /** True: nothing outside of the box is shown. */
    on: boolean;
  };
  /** Planes that cut the scene open, by name. */
  sections: Record<string, {
    /** Watertight parts are closed where it cuts them. */
    caps: boolean;
    /** Of the plane from the world's origin, along `normal`. */
    distance: number;
    /** The caps have lines across. */
    hatched: boolean;
    /** Where it leads is cut away; unit, of any length but 0 in a patch. A new plane must have it. */
    normal: Array<number>;
    /** False: it cuts nothing. */
    on: boolean;
  }>;
  /** What is selected. */
  selection: {
    /** The innermost node of `path` that has a hinge. */
    hinge?: number;
    /** Name of the selected node. */
    name?: string;
    /** The node that is selected. */
    node?: number;
    /** Names from the root to the selected node, the last 32. */
    path?: Array<string>;
    /** Ids of the nodes in `path`. */
    pathIds?: Array<number>;
  };
  /** Nodes that are on their way about their hinges, by id. */
  swings: Record<string, {
    /** Where it goes: 0 closed, 1 open. */
    to: number;
  }>;
  /** Of lengths. */
  unit: {
    /** Of one unit of the scene; from the file, or 0.001. */
    metres: number;
    /** The unit in which pages show lengths. */
    shown: 'mm' | 'cm' | 'm' | 'in';
  };
  /** Saved cameras, by name. */
  views: Record<string, {
    /** The centre of rotation. */
    center: Array<number>;
    /** Where the camera stands. */
    eye: Array<number>;
    /** What it looks at. */
    focus: Array<number>;
    /** The vertical angle of view in degrees. */
    fov: number;
    /** For clients to sort by: the lowest first, then those without one, by name. */
    order?: number;
    /** Which way is up in the image; unit, at right angles to the view. */
    up: Array<number>;
  }>;
  /** The camera that hosts have, while it is behind that of all. */
  walls?: {
    /** How far its view has to turn. */
    behindDegrees: number;
    /** How far its eye has to move, by the scene's unit. */
    behindMetres: number;
    /** The centre of rotation. */
    center: Array<number>;
    /** Where that camera stands. */
    eye: Array<number>;
    /** Far end of its clip range. */
    far: number;
    /** What it looks at. */
    focus: Array<number>;
    /** The vertical angle of view in degrees. */
    fov: number;
    /** Near end of its clip range. */
    near: number;
    /** Which way is up; unit, at right angles to the view. */
    up: Array<number>;
  };
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
  comfort?: null | {
    degreesPerSecond?: null | number;
    degreesPerSecondSquared?: null | number;
    metresPerSecond?: null | number;
    metresPerSecondSquared?: null | number;
    on?: null | boolean;
  };
  cues?: null | Record<string, null | {
    backgrounds?: null | {
      active?: null | string;
      color?: null | Array<number>;
    };
    camera?: null | {
      center?: null | Array<number>;
      eye?: null | Array<number>;
      focus?: null | Array<number>;
      fov?: null | number;
      up?: null | Array<number>;
    };
    easing?: null | 'smooth' | 'linear';
    lights?: null | {
      active?: null | string;
    };
    ms?: null | number;
    nodes?: null | Record<string, null | {
      active?: null | boolean;
      activeChild?: null | number;
      material?: null | number;
      matrix?: null | Array<number>;
    }>;
    order?: null | number;
    sectionBox?: null | {
      caps?: null | boolean;
      hatched?: null | boolean;
      max?: null | Array<number>;
      min?: null | Array<number>;
      on?: null | boolean;
    };
    sections?: null | Record<string, null | {
      caps?: null | boolean;
      distance?: null | number;
      hatched?: null | boolean;
      normal?: null | Array<number>;
      on?: null | boolean;
    }>;
    selection?: null | {
      node?: null | number;
    };
    text?: null | string;
  }>;
  lights?: null | {
    active?: null | string;
    items?: null | Record<string, null | {
      attenuation?: null | Array<number>;
      color?: null | Array<number>;
    }>;
  };
  markers?: null | Record<string, null | {
    author?: null | string;
    done?: null | boolean;
    node?: null | number;
    point?: null | Array<number>;
    text?: null | string;
    time?: null | number;
    view?: null | {
      /** The centre of rotation. */
      center: Array<number>;
      /** Where the camera stands. */
      eye: Array<number>;
      /** What it looks at. */
      focus: Array<number>;
      /** The vertical angle of view in degrees. */
      fov: number;
      /** Which way is up in the image; unit, at right angles to the view. */
      up: Array<number>;
    };
  }>;
  measures?: null | Record<string, null | {
    kind?: null | 'distance' | 'parallel' | 'angle' | 'radius' | 'length';
    picks?: null | Array<Feature>;
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
  pointing?: null | {
    watchers?: null | boolean;
  };
  quality?: null | {
    latencyTargetMs?: null | number;
    preference?: null | number;
  };
  renderer?: null | {
    mode?: null | 'realistic' | 'stylized';
    showSelection?: null | boolean;
    wireframe?: null | boolean;
  };
  sectionBox?: null | {
    caps?: null | boolean;
    hatched?: null | boolean;
    max?: null | Array<number>;
    min?: null | Array<number>;
    on?: null | boolean;
  };
  sections?: null | Record<string, null | {
    caps?: null | boolean;
    distance?: null | number;
    hatched?: null | boolean;
    normal?: null | Array<number>;
    on?: null | boolean;
  }>;
  selection?: null | {
    node?: null | number;
  };
  unit?: null | {
    metres?: null | number;
    shown?: null | 'mm' | 'cm' | 'm' | 'in';
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

export type View = {
  /** CSS pixels; fractions are allowed. */
  height: number;
  /** What lies on the view's sides and covers it, in CSS pixels. */
  inset?: {
    /** Covered at the bottom. */
    bottom?: number;
    /** Covered at the left. */
    left?: number;
    /** Covered at the right. */
    right?: number;
    /** Covered at the top. */
    top?: number;
  };
  /** Pixels of the image to a CSS pixel. */
  pixelRatio: number;
  /** CSS pixels; fractions are allowed. */
  width: number;
};
