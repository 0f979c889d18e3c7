// Declares the used part. Its published types would include node's, which are wrong in a browser.
declare module 'papaparse' {
  interface Result<T> {
    data: T[];
    errors: {type: string; message: string; row?: number}[];
  }
  const Papa: {parse<T>(text: string, options: {skipEmptyLines?: boolean | 'greedy'; delimiter?: string}): Result<T>};
  export default Papa;
}
