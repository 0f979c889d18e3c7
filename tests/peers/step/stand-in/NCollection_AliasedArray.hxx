#pragma once
// Declares a class of Open CASCADE 7.6 that other headers name but Debian 12's package omits; only
// triangulations would call it, and nothing here has any.
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

 protected:
  unsigned char* myData = nullptr;
  int myStride = 0;
};
