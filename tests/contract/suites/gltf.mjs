// Every glTF the service offers, read by Khronos' validator: no error, and the nodes the contract names.
import validator from 'gltf-validator';

const MEDIA = 'model/gltf-binary';

function nodesOf(bytes) {
  const length = bytes.readUInt32LE(12);
  return JSON.parse(bytes.subarray(20, 20 + length).toString('utf8'));
}

export async function gltf({service, contract, report}) {
  let files = 0;
  for (const endpoint of contract.posts()) {
    for (const {name, body} of endpoint.examples) {
      const reply = await service.post(endpoint.path, body, {headers: {Accept: MEDIA}});
      if (reply.status === 406) continue;
      const about = `${endpoint.id} ${name}`;
      report.expect(reply.status === 200, about, `status ${reply.status}`);
      if (reply.status !== 200) continue;
      files += 1;
      const {issues} = await validator.validateBytes(new Uint8Array(reply.body), {format: 'glb'});
      report.expect(issues.numErrors === 0 && issues.numWarnings === 0, about,
        JSON.stringify(issues.messages.filter(({severity}) => severity < 2).slice(0, 3)));
      const {nodes, scenes, scene} = nodesOf(reply.body);
      const shown = scenes.map((each) => each.nodes.map((node) => nodes[node].name));
      report.expect(shown.every((names) => !(names.includes('before') && names.includes('after'))), about, `a scene of ${shown.join(' and ')}`);
      report.expect(!shown[scene].includes('before'), about, 'opens with what was before');
      if (endpoint.id === 'bevel-tables')
        report.expect(nodes.map((node) => node.name).join() === 'before,after', about, `nodes ${nodes.map((node) => node.name)}`);
    }
  }
  report.expect(files >= 5, 'glTF', `only ${files} files`);
  return [`${files} glTF files without an error or a warning`];
}
