import {BufferAttribute, BufferGeometry, type Color, type Intersection, type Matrix4, Mesh, type MeshLambertMaterial, type Raycaster, Vector3} from 'three';

/** The mesh of a member at its place. */
export interface Piece {
  geometry: BufferGeometry;
  place: Matrix4;
  member: number;
}
/** A piece in the common geometry: its vertices, and its corners of triangles. */
interface Run {
  vertex: number;
  vertices: number;
  corner: number;
  corners: number;
}

/**
 * Many members as one mesh, because each draw call costs more than the triangles of a member that is seen from afar. Its
 * vertices have the colour of their member.
 */
export class Crowd extends Mesh<BufferGeometry, MeshLambertMaterial> {
  private readonly runs = new Map<number, Run[]>(); // by member
  private readonly hues = new Map<number, number>(); // as they are drawn

  constructor(
    pieces: Piece[],
    readonly materials: {whole: MeshLambertMaterial; cut: MeshLambertMaterial},
  ) {
    super(new BufferGeometry(), materials.whole);
    const total = pieces.reduce((sum, {geometry}) => sum + geometry.getAttribute('position').count, 0);
    const [positions, normals] = [new Float32Array(3 * total), new Float32Array(3 * total)];
    const index: number[] = [];
    const at = new Vector3();
    let vertex = 0;
    for (const {geometry, place, member} of pieces) {
      const [from, way, own] = [geometry.getAttribute('position'), geometry.getAttribute('normal'), geometry.getIndex()];
      const corner = index.length;
      for (let i = 0; i < from.count; ++i) {
        at.fromBufferAttribute(from, i)
          .applyMatrix4(place)
          .toArray(positions, 3 * (vertex + i));
        at.fromBufferAttribute(way, i)
          .transformDirection(place)
          .toArray(normals, 3 * (vertex + i));
      }
      for (let i = 0; i < (own?.count ?? from.count); ++i) index.push(vertex + (own ? own.getX(i) : i));
      this.runs.set(member, [...(this.runs.get(member) ?? []), {vertex, vertices: from.count, corner, corners: index.length - corner}]);
      vertex += from.count;
    }
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    this.geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * total), 3));
    this.geometry.setIndex(index);
  }

  paint(hue: (member: number) => Color): void {
    const colours = this.geometry.getAttribute('color') as BufferAttribute;
    for (const [member, runs] of this.runs) {
      const wanted = hue(member);
      if (this.hues.get(member) === wanted.getHex()) continue;
      this.hues.set(member, wanted.getHex());
      for (const {vertex, vertices} of runs) {
        for (let i = vertex; i < vertex + vertices; ++i) colours.setXYZ(i, wanted.r, wanted.g, wanted.b);
        colours.addUpdateRange(3 * vertex, 3 * vertices);
      }
      colours.needsUpdate = true;
    }
  }

  /** Where a ray meets these members. */
  hits(caster: Raycaster, members: number[]): {member: number; hit: Intersection}[] {
    const found = members.flatMap((member) =>
      (this.runs.get(member) ?? []).flatMap(({corner, corners}) => {
        const hits: Intersection[] = [];
        this.geometry.setDrawRange(corner, corners);
        this.raycast(caster, hits);
        return hits.map((hit) => ({member, hit}));
      }),
    );
    this.geometry.setDrawRange(0, Infinity);
    return found;
  }
}
