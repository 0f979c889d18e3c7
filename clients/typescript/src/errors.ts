/** The client's errors. */
import type {components} from './schema.js';

export type Problem = components['schemas']['Problem'];

/** A refusal or failure reported by the service: the fields, their values and the limits. */
export class ProblemError extends Error {
  constructor(readonly problem: Problem) {
    super(`${problem.status} ${problem.code}: ${problem.detail}`);
    this.name = 'ProblemError';
  }
}

/** The answer's body does not match the contract, or is missing. */
export class ContractError extends Error {
  override name = 'ContractError';
}

/** No replica answered within the client's patience. */
export class UnreachableError extends Error {
  override name = 'UnreachableError';
}

export const isProblem = (error: unknown): error is Problem =>
  typeof error === 'object' && error !== null && 'code' in error && 'errors' in error;

/** Of a reply that is no answer. */
export async function refusal(reply: Response): Promise<Error> {
  const error: unknown = await reply.json().catch(() => undefined);
  return isProblem(error) ? new ProblemError(error) : new ContractError(`${reply.status} from ${reply.url} without a problem document`);
}
