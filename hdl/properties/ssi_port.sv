// rests_high: The clock is HIGH whenever no frame is under way, behind its last rising edge and within the recovery time.
// one_result: A trigger that meets no frame has exactly one result, and there is none without.
// only_on_high: The clock falls for the first time only for a trigger, with DATA HIGH and a kind of frame that may go out.
// counted_twice: Both counts of bits are the same, and fit what is left of the copy.
// as_it_came: What is stored is what came: the sum of its bits is that of the bits as they were taken, unless there were more than 48.
// good_is_whole: A position is taken only if DATA was HIGH before the frame and LOW behind it, its parity bit fits, and both copies are the same.
reg f_owed; initial f_owed = 1'b0;
reg f_full; initial f_full = 1'b0;
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (ended) f_owed <= 1'b0;
    if (trigger & (state == AT_REST)) f_owed <= 1'b1;
    if (reset) f_owed <= 1'b0;
    if (takes_bit & !is_parity & !second & word[47]) f_full <= 1'b1;
    if ((trigger & (state == AT_REST)) | reset) f_full <= 1'b0;
end
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ((state == AT_LOW) & $past(state == AT_REST)) only_on_high: assert ($past(trigger & filter_level & frame[2]));
end
wire f_runs = (state == AT_LOW) | (state == AT_HIGH) | (state == AT_LAST);
always @* begin
    rests_high: assert (clk | (state == AT_LOW));
    one_result: assert (f_owed == (f_runs | ended));
    one_result_once: assert (!ended | (state == AT_RECOVERY) | (state == AT_REST));
    counted_twice: assert ((left == left_too) & !torn);
    as_it_came: assert (f_full | ((^word) == sum));
    good_is_whole: assert (!snapshot_good | (!not_high & !not_low & !unknown & !not_even & (!frame[1] | (word == again))));
end
