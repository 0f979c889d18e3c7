#pragma once
// What other headers of Open CASCADE 7.6 name of a class that Debian 12's package leaves out;
// triangulations alone would call it, and nothing here has any.
template <int Align = 16>
class NCollection_AliasedArray {
 public:
  explicit NCollection_AliasedArray(int) {}
  NCollection_AliasedArray(int, int) {}
  template <class T>
  NCollection_AliasedArray(const T&, int) {}
  int Size() const;
  int Length() const;
  int Lower() const;
  int Upper() const;
  int Stride() const;
  bool IsEmpty() const;
  bool IsDeletable() const;
  NCollection_AliasedArray& Assign(const NCollection_AliasedArray&);
  NCollection_AliasedArray& Move(NCollection_AliasedArray&);
  void Resize(int, bool);
  template <class T>
  const T& Value(int) const;
  template <class T>
  void Value(int, T&) const;
  template <class T>
  T& ChangeValue(int);
};
