// JSON text as a tree that keeps the printed form of every leaf, so that a part can be hashed, or one member changed and
// nothing else.
export function parseRaw(text) {
  let at = 0;
  const token = /"(?:[^"\\]|\\.)*"|[^\s,:[\]{}"]+/y;
  const leaf = () => {
    token.lastIndex = at;
    const [found] = token.exec(text);
    at += found.length;
    return found;
  };
  const until = (close, read) => {
    const items = [];
    at += 1;
    while (text[at] !== close) {
      items.push(read());
      if (text[at] === ',') at += 1;
    }
    at += 1;
    return items;
  };
  const value = () => {
    if (text[at] === '{') {
      return {members: until('}', () => {
        const name = JSON.parse(leaf());
        at += 1;
        return [name, value()];
      })};
    }
    if (text[at] === '[') return {items: until(']', value)};
    return {leaf: leaf()};
  };
  return value();
}

export function print(node) {
  if (node.members) return `{${node.members.map(([name, value]) => `${JSON.stringify(name)}:${print(value)}`).join()}}`;
  if (node.items) return `[${node.items.map(print).join()}]`;
  return node.leaf;
}

export function member(node, name) {
  return node.members?.find(([key]) => key === name)?.[1];
}

export function without(node, names) {
  return {members: node.members.filter(([name]) => !names.includes(name))};
}

// Every object of the tree with the place it has in the schema: array indices become *.
export function* objects(node, place = '') {
  if (node.members) {
    yield [place, node];
    for (const [name, value] of node.members) yield* objects(value, `${place}/${name}`);
  } else if (node.items) {
    for (const item of node.items) yield* objects(item, `${place}/*`);
  }
}
