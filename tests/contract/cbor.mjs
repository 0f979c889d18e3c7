// The part of CBOR (RFC 8949) that answers use, read back into the values JSON.parse gives; RFC 8746 typed arrays become lists.
export function decode(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;

  const uint = (info) => {
    if (info < 24) return info;
    const size = 1 << (info - 24);
    const value = [() => view.getUint8(at), () => view.getUint16(at), () => view.getUint32(at),
      () => Number(view.getBigUint64(at))][info - 24]();
    at += size;
    return value;
  };
  const list = (count, item) => Array.from({length: count}, item);
  const slice = (length) => bytes.subarray(at, at += length);
  const half = (h) => {
    const exponent = (h >> 10) & 31;
    const fraction = h & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24 : (1024 + fraction) * 2 ** (exponent - 25);
    return h & 0x8000 ? -size : size;
  };
  const simple = (info) => {
    if (info === 20 || info === 21) return info === 21;
    if (info === 22) return null;
    const start = at;
    at += 2 ** (info - 24);
    if (info === 25) return half(view.getUint16(start));
    if (info === 26) return view.getFloat32(start);
    if (info === 27) return view.getFloat64(start);
    throw new Error(`simple value ${info} at byte ${start}`);
  };
  const typed = (tag) => {
    const data = item();
    const part = new DataView(data.buffer, data.byteOffset, data.byteLength);
    if (tag === 77) return list(data.length / 2, (_, i) => part.getInt16(2 * i, true));
    if (tag === 78) return list(data.length / 4, (_, i) => part.getInt32(4 * i, true));
    throw new Error(`tag ${tag}`);
  };
  const item = () => {
    const head = view.getUint8(at);
    at += 1;
    const [major, info] = [head >> 5, head & 31];
    if (major === 7) return simple(info);
    const n = uint(info);
    switch (major) {
      case 0: return n;
      case 1: return -1 - n;
      case 2: return slice(n);
      case 3: return Buffer.from(slice(n)).toString('utf8');
      case 4: return list(n, item);
      case 5: return Object.fromEntries(list(n, () => [item(), item()]));
      default: return typed(n);
    }
  };

  const value = item();
  if (at !== bytes.length) throw new Error(`${bytes.length - at} bytes behind the item`);
  return value;
}
