import {fetched} from './service';

/** A row of a machine's process table. */
export interface Process {
  material: string;
  metal_max_mm: number;
}
export interface Listed {
  machines: {name: string; machine: {type?: string}; process?: {rows: Process[]}}[];
  posts: {name: string; post: {what: string; kind?: string}}[];
}

let kept: Promise<Listed> | undefined;

/** Machines with their process tables, and posts: asked for when they are first needed. */
export function listed(): Promise<Listed> {
  kept ??= Promise.all([fetched<Pick<Listed, 'machines'>>('/v1/machines'), fetched<Pick<Listed, 'posts'>>('/v1/posts')]).then(([machines, posts]) => ({
    ...machines,
    ...posts,
  }));
  kept.catch(() => {
    kept = undefined; // asked again when it is next needed
  });
  return kept;
}
