/// <reference lib="dom" />

/** Positions and directions are in world units. */
export type Vec3 = [number, number, number];
export type Data = Blob | ArrayBuffer | Uint8Array;
/** A Uint8Array with an ArrayBuffer of its own, in all versions of TypeScript. */
export type Bytes = ReturnType<typeof Uint8Array.from>;

/** Triangles in arrays. */
export interface Mesh {
  /** x, y, z of each vertex. */
  positions: ArrayLike<number>;
  /** Three vertices of each triangle; without them, each three vertices that follow each other are one. */
  indices?: ArrayLike<number> | null;
  /** Red, green, blue of each vertex, sRGB encoded: 0 to 255 in a Uint8Array or Uint8ClampedArray, else 0 to 1. */
  colors?: ArrayLike<number> | null;
}

/** A file: an .obj, .glb, .ply, .stl, .vox, .las, .npy ..., or a .zip of files. */
export interface NamedFile {
  /** With the folders that other files name it by, such as `textures/wall.png`. */
  name: string;
  data: Data;
}

export interface Job {
  /** Ends the work: the promise then rejects with its reason. */
  signal?: AbortSignal;
  /** Takes the part that is done, 0 to 1, of each stage of the work. */
  onProgress?: (part: number) => void;
}

export interface BuildOptions extends Job {
  /** Voxels along the longest side of a mesh or of points; default: 1024. */
  resolution?: number;
  /** Whether to store the colours that the input has; default: true. */
  colors?: boolean;
  /** Whether to set the voxels inside a mesh, too; default: false. */
  solid?: boolean;
  /** More options of `voxdag build` or `voxdag import`, such as `['--normal', '--up', 'z']`. */
  args?: string[];
}

export interface SaveOptions extends Job {
  /** More options of `voxdag export`, such as `['--smooth']`. */
  args?: string[];
}

/** The first cell that a ray meets. */
export interface Hit {
  /** The lowest voxel of the cell. */
  voxel: Vec3;
  /** Level of the cell: that of the voxels is `info.levels`. */
  level: number;
  /** The side through which the ray enters: 2 * axis, plus 1 for the upper side; -1 if it starts inside. */
  face: number;
  position: Vec3;
  /** From the ray's origin, in lengths of its direction. */
  distance: number;
}

/** `fov`: vertical degrees. */
export interface Camera { eye: Vec3; target: Vec3; up: Vec3; fov: number }
export interface Box { low: Vec3; high: Vec3 }
export type Unit = 'm' | 'cm' | 'mm' | 'in' | 'ft';

export interface SceneInfo {
  /** Of the file that the scene was built of. */
  name: string;
  /** The grid has 2^levels voxels a side. */
  levels: number;
  resolution: number;
  /** The lowest corner of the grid. */
  origin: Vec3;
  voxelSize: number;
  /** Of the set voxels, to the cells of level 9. */
  bounds: Box;
  voxels: number;
  dagNodesPerLevel: number[];
  fileBytes: number;
  hasColors: boolean;
  hasNormals: boolean;
  /** Names by id; null if the file has none. */
  materials: string[] | null;
  /** `kind`: 'u8', 'u16', 'i16', 'i32' or 'f32'; a value differs from the one that was given by at most `bound`. */
  channels: { name: string; kind: string; bound: number }[];
  /** The view that the scene suggests; of open() and build() for a square picture. */
  view: Camera;
  /** The view of the file, with the direction to the sun if it is an interior. */
  home: (Camera & { sun?: Vec3 }) | null;
  /** Of world units, if the file says it. */
  unit: Unit | null;
}

/** A scene in memory. */
export interface Scene {
  readonly info: SceneInfo;
  /** The .vdag file. */
  readonly bytes: Bytes;
  /** What build() had to say of its input. */
  readonly warnings: readonly string[];
  /** Returns whether a point lies in a set voxel. */
  contains(point: Vec3): boolean;
  /** Returns the first voxel along a ray, at most `most` lengths of `direction` away; null without one. */
  cast(origin: Vec3, direction: Vec3, most?: number): Hit | null;
  /** Returns the number of the material of a hit; null without materials. */
  material(hit: Hit): number | null;
  /** Returns the voxels as another file: 'glb', 'ply', 'stl', 'obj', '3mf', 'vox' ... (docs/export.md). */
  save(format: string, options?: SaveOptions): Promise<Bytes>;
}

/** Builds a scene of a mesh, or of the largest mesh among files; without meshes of voxels, a volume, or points. */
export function build(input: Mesh | NamedFile | NamedFile[], options?: BuildOptions): Promise<Scene>;

/** Opens a .vdag file, or a page that `voxdag export` wrote. */
export function open(data: Data, options?: { signal?: AbortSignal }): Promise<Scene>;

/**
 * Runs the command line (docs/cli.md): `run(['info', '/in/a.vdag', '--json'], [{ name: 'a.vdag', data }])`. The program sees the files
 * in /in, and what it writes into /out comes back.
 */
export function run(args: string[], files?: NamedFile[], job?: Job): Promise<{ out: string; warnings: string[]; files: { name: string; bytes: Bytes }[] }>;

/** Settings of a picture: those of docs/viewer.md. Changes hold the keys that differ. */
export interface Settings {
  /** null: the view that the scene suggests. */
  camera: Camera | null;
  /** `direction`: to the sun, null for the usual one; `angle`: its diameter in degrees. */
  sun: { direction: Vec3 | null; angle: number; on: boolean };
  /** Factor on the light of the sky. */
  sky: number;
  /** How often light is reflected; null: surfaces occlude each other. */
  bounces: number | null;
  /** Factor before tone mapping; 0: automatic. */
  exposure: number;
  tone: 'neutral' | 'agx' | 'filmic';
  background: 'sky' | 'grey' | 'white' | 'black';
  /** Whether a ground under the scene shows its shadow. */
  ground: boolean;
  shadows: boolean;
  occlusion: { samples: number; distance: number; cone: number };
  /** Finest level; null: all. */
  level: number | null;
  colors: boolean;
  normals: boolean;
  /** Numbers of the materials that are hidden. */
  hidden: number[];
  show: 'light' | 'level' | 'steps' | 'sharing' | 'normal' | 'depth' | 'occlusion';
  /** The channel whose values are the colours, or ''; the values of the first and the last colour, null: those of the channel. */
  channel: { name: string; range: [number, number] | null };
  section: { box: Box | null; plane: { point: Vec3; normal: Vec3 } | null; hatch: boolean };
  /** How Hands move the camera. */
  mode: 'orbit' | 'fly' | 'walk';
}
export type SettingsChanges = { [K in keyof Settings]?: Settings[K] extends unknown[] | null ? Settings[K]
  : Settings[K] extends object | null ? Partial<NonNullable<Settings[K]>> | Extract<Settings[K], null> : Settings[K] };

export interface Viewer {
  readonly canvas: HTMLCanvasElement;
  /** null until the file's header is read. */
  readonly info: SceneInfo | null;
  /** Shows the scene of a .vdag file in place of the present one. */
  open(file: File): Promise<void>;
  /** Events: 'info', 'progress', 'level', 'loaded', 'still', 'error' ... (docs/viewer.md). */
  on(event: string, handler: (...values: any[]) => void): void;
  off(event: string, handler: (...values: any[]) => void): void;
  get(): Settings;
  set(changes: SettingsChanges): void;
  camera(): Camera;
  /** Shows the whole scene from the present direction. */
  frame(): void;
  /** Returns the first voxel under a point of the canvas, in CSS pixels. */
  pick(x: number, y: number): Promise<Hit | null>;
  contains(point: Vec3): boolean;
  castNow(origin: Vec3, direction: Vec3, most: number): Hit | null;
  material(hit: Hit): number | null;
  /** The channel that is shown, once it has arrived: its least and greatest value, those of the first and the last colour, and the colours. */
  channel(): { name: string; values: [number, number]; range: [number, number]; colors: number[][] } | null;
  /** The value of that channel at a hit; null for cells that edits added. */
  channelValue(hit: Hit): number | null;
  /** Returns a PNG in full quality, once the scene has arrived. */
  capture(options?: { width?: number; height?: number; samples?: number; camera?: Camera; signal?: AbortSignal; progress?: (part: number) => void }): Promise<Blob>;
  /** Waits for the finished picture. */
  whenStill(): Promise<void>;
  destroy(): void;
}

/**
 * Makes a picture that fills `container`, of the .vdag file at `url` or in `bytes`; without both it waits for open(). Needs a browser
 * with WebGL 2; failures are 'error' events { title, text }.
 */
export function createViewer(options: { container: HTMLElement; url?: string; bytes?: ArrayBuffer | Uint8Array; settings?: SettingsChanges }): Viewer;

/** Moves the camera of a viewer by mouse, touch, keys and gamepad. */
export class Hands {
  /** `keyboard`: whose keys count; default: the window. */
  constructor(viewer: Viewer, options?: { keyboard?: EventTarget });
  destroy(): void;
}
