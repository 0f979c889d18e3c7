// The contract as data: its schemas compiled, its endpoints listed.
import {readFileSync} from 'node:fs';
import Ajv2020 from 'ajv/dist/2020.js';
import addFormats from 'ajv-formats';
import {parse} from 'yaml';

const ID = 'contract';

export class Contract {
  constructor(file) {
    this.document = parse(readFileSync(file, 'utf8'));
    this.ajv = new Ajv2020({strict: false, allErrors: true, logger: false});
    addFormats(this.ajv);
    this.ajv.addSchema(this.document, ID);
    this.validPart = this.validator('#/components/schemas/PartsResponse');
  }

  // Reads the service's endpoints (or only one), and requests that run.
  async learn(service, only) {
    const {endpoints} = JSON.parse((await service.ask('/v1/version', {method: 'GET'})).text);
    this.served = endpoints.filter(({id}) => !only || id === only).map(({path}) => path);
    this.examples = JSON.parse((await service.ask('/v1/examples', {method: 'GET'})).text).examples;
    return this;
  }

  // The schema a reference names, else the schema itself.
  resolve(schema) {
    while (schema?.$ref) schema = this.at(schema.$ref);
    // A choice that some values fit twice, such as the name of a size, is drawn like one that none
    // does. Its branches are those of both, because an edit compares each with the others.
    if (schema?.anyOf?.every((branch) => branch.$ref)) return {oneOf: schema.anyOf.flatMap((branch) => this.resolve(branch).oneOf ?? [branch])};
    return schema;
  }

  at(reference) {
    return reference.slice(2).split('/').reduce((node, step) => node[step], this.document);
  }

  validator(reference) {
    return this.ajv.compile({$ref: `${ID}${reference}`});
  }

  // Returns ajv's errors for a value, [] if it is valid.
  faults(validate, value) {
    if (validate(value)) return [];
    return validate.errors.map((e) => `${e.instancePath || '/'} ${e.message} ${JSON.stringify(e.params)}`);
  }

  // The endpoints the service has; tools/check_openapi compares them with the contract's.
  posts() {
    return Object.entries(this.document.paths).filter(([path, item]) => item.post && this.served.includes(path)).map(([path, item]) => {
      const request = item.post.requestBody.content['application/json'].schema.$ref;
      const response = item.post.responses['200'].content['application/json'].schema.$ref;
      return {
        path,
        id: path.replace('/v1/', ''),
        codes: item.post['x-problem-codes'] ?? [],
        examples: this.examples.filter(({endpoint}) => path === `/v1/${endpoint}`),
        request: this.at(request),
        response: this.at(response),
        validRequest: this.validator(request),
        validResponse: this.validator(response),
      };
    });
  }

  gets() {
    return Object.entries(this.document.paths).filter(([, item]) => item.get).map(([path, item]) => {
      const schema = item.get.responses['200'].content['application/json']?.schema;
      return {path, valid: schema ? this.validator(schema.$ref) : undefined};
    });
  }

  problem() {
    return this.validator('#/components/schemas/Problem');
  }
}
