/** Files in memory by their names; parts of a name between / are folders. */
export type Files = Record<string, Uint8Array | string>;

/** Why there is no result. `code` is the program's exit code: 2 usage, 3 bad input, 5 graphics or resources, 6 internal. */
export declare class GnomonError extends Error {
  readonly code: number;
}

/** A picture as 32-bit floats, row 0 at the top. docs/manual/aov.md lists the channels. */
export interface Frame {
  width: number;
  height: number;
  channels: Record<string, Float32Array>;
}

/** What index.mjs itself takes beside a command's options. */
export interface Wanted {
  /** Returns the report, a page that stands alone. */
  report?: boolean;
  /** Returns every per-pixel number. */
  channels?: boolean;
}

export interface Comparison {
  /** 0; 1 where a limit of `fail_above` is not kept. */
  code: 0 | 1;
  result: Result;
  report?: string;
  frame?: Frame;
}

export interface Scene {
  /** What the scene calls for (`gnomon plan --json -`). */
  readonly plan: unknown;
  /** Draws by shadow maps: linear colour, ids and, of each light, visibility. Needs WebGL 2, which Node has not (code 5). */
  draw(options?: DrawOptions): Promise<Frame>;
  /** Returns the same picture as PNG. */
  drawPicture(options?: DrawOptions): Promise<Uint8Array>;
  /** Traces rays: linear colour, depth, position, normal, ids and, of each light, visibility. */
  trace(options?: TraceOptions): Promise<Frame>;
  /** Returns the same picture as PNG. */
  tracePicture(options?: TraceOptions): Promise<Uint8Array>;
  /** Compares the shadows of both, pixel by pixel. Needs WebGL 2, which Node has not (code 5). */
  compare(options?: CompareOptions & Wanted): Promise<Comparison>;
}

/** Loads a scene: the name of a built-in one, or of one of the files (.json .gltf .glb .obj .ply), beside which it looks for others. */
export declare function load(name: string, files?: Files): Promise<Scene>;

/** Judges the shadow that another renderer drew: the name of a capture (gnomon/capture/2) among the files, with its pictures. */
export declare function judge(capture: string, files: Files, options?: JudgeOptions & Wanted): Promise<Comparison>;

/** Ends the worker and gives its memory back; the next call starts another. */
export declare function close(): Promise<void>;
