// An encoder, written from its own side and strict: `wrong` stays HIGH once the clock, the command or the driver of the receiver was not
// what EnDat says. Its times are system clock cycles. It shares nothing with the receiver that it is proved with.
module encoder_of_proof #(
    parameter BITS = 13, HAS_F2 = 1, COMMAND = 6'b111000, TCAL_CYCLES = 40, TM_CYCLES = 60, HAS_INFO_1 = 0, HAS_INFO_2 = 0
) (
    input  wire            clock,
    input  wire            clk_pin,
    input  wire            is_driven,
    input  wire            data_pin,
    input  wire [BITS-1:0] position,
    // additional data: status, code and content
    input  wire     [23:0] info_1,
    input  wire     [23:0] info_2,
    output wire            drives,
    output wire            value,
    output wire            wrong,
    output wire [BITS-1:0] sent,
    output wire     [23:0] sent_1,
    output wire     [23:0] sent_2
);
    // start bit, F1, F2
    localparam [6:0] HEAD = 7'd2 + HAS_F2;
    localparam [6:0] ANSWER = HEAD + BITS + 7'd5;
    // behind it additional data 2, then 1: a LOW, 24 bits with the highest one first, their CRC
    localparam [1:0] INFOS = HAS_INFO_1 + HAS_INFO_2;
    localparam [6:0] BLOCK = 7'd30;
    localparam REST = 2'd0, LISTENS = 2'd1, SENDS = 2'd2, RECOVERS = 2'd3;
    reg [1:0] state; initial state = REST;
    reg clk_before; initial clk_before = 1'b1;
    reg drives_now; initial drives_now = 1'b1;
    reg value_now; initial value_now = 1'b0;
    reg wrong_now; initial wrong_now = 1'b0;
    reg [3:0] falls; initial falls = 4'd0;
    reg [3:0] rises; initial rises = 4'd0;
    reg [6:0] cells; initial cells = 7'd0;
    reg [5:0] heard; initial heard = 6'd0;
    reg [15:0] age; initial age = 16'd0;
    reg [BITS-1:0] latched; initial latched = 0;
    reg [BITS-1:0] left; initial left = 0;
    reg [23:0] latched_1; initial latched_1 = 24'd0;
    reg [23:0] latched_2; initial latched_2 = 24'd0;
    reg [23:0] word; initial word = 24'd0;
    reg in_info; initial in_info = 1'b0;
    reg [1:0] infos_left; initial infos_left = 2'd0;
    reg [4:0] crc; initial crc = 5'd0;
    wire fall = clk_before & !clk_pin;
    wire rise = !clk_before & clk_pin;
    // F1 LOW and F2 HIGH: no alarm; the position from bit 0 on, then the inverted CRC
    wire covered = in_info ? (cells < 7'd25) : (cells < HEAD + BITS);
    wire ended = in_info ? (cells == BLOCK) : (cells == ANSWER);
    wire position_value = (cells == 7'd1) ? 1'b0 : (cells < HEAD) ? 1'b1 : left[0];
    wire cell_value = !covered ? !crc[4] : in_info ? word[23] : position_value;
    wire feed = crc[4] ^ cell_value;
    always @(posedge clock) begin
        clk_before <= clk_pin;
        if (state != REST) age <= age + 16'd1;
        case (state)
            REST: begin
                if (rise) wrong_now <= 1'b1;
                if (fall) begin
                    state <= LISTENS;
                    falls <= 4'd1;
                    rises <= 4'd0;
                    heard <= 6'd0;
                    age <= 16'd0;
                    drives_now <= 1'b0;
                    latched <= position;
                    latched_1 <= info_1;
                    latched_2 <= info_2;
                end
            end
            LISTENS: begin
                if (fall & (falls != 4'd15)) falls <= falls + 4'd1;
                if (fall & (falls == 4'd9)) drives_now <= 1'b1;
                if (rise) begin
                    if (rises != 4'd15) rises <= rises + 4'd1;
                    // the driver is on from the second falling edge to the ninth
                    if (is_driven != ((rises >= 4'd1) & (rises <= 4'd7))) wrong_now <= 1'b1;
                    if ((rises >= 4'd2) & (rises <= 4'd7)) heard <= {heard[4:0], data_pin};
                    if ((rises == 4'd8) & (heard != COMMAND)) wrong_now <= 1'b1;
                    if ((rises >= 4'd10) & (age >= TCAL_CYCLES)) begin
                        state <= SENDS;
                        value_now <= 1'b1;
                        cells <= 7'd1;
                        left <= latched;
                        crc <= 5'd31;
                        in_info <= 1'b0;
                        infos_left <= INFOS;
                    end
                end
            end
            SENDS: if (rise) begin
                if (!ended) begin
                    value_now <= cell_value;
                    cells <= cells + 7'd1;
                    if (!in_info & covered & (cells >= HEAD)) left <= left >> 1;
                    if (in_info) word <= {word[22:0], 1'b0};
                    // x^5 + x^3 + x + 1
                    crc <= covered ? {crc[3], crc[2] ^ feed, crc[1], crc[0] ^ feed, feed} : {crc[3:0], 1'b0};
                end else if (infos_left != 2'd0) begin
                    value_now <= 1'b0;
                    in_info <= 1'b1;
                    infos_left <= infos_left - 2'd1;
                    word <= ((HAS_INFO_2 != 0) & (infos_left == INFOS)) ? latched_2 : latched_1;
                    cells <= 7'd1;
                    crc <= 5'd31;
                end else begin
                    state <= RECOVERS;
                    value_now <= 1'b1;
                    age <= 16'd0;
                end
            end
            // not one pulse more
            RECOVERS: begin
                if (fall | rise) wrong_now <= 1'b1;
                if (age == TM_CYCLES) begin
                    value_now <= 1'b0;
                    state <= REST;
                end
            end
        endcase
    end
    assign drives = drives_now;
    assign value = value_now;
    assign wrong = wrong_now;
    assign sent = latched;
    assign sent_1 = latched_1;
    assign sent_2 = latched_2;
endmodule

// A wire as it arrives so many cycles later.
module way_of_proof #(
    parameter CYCLES = 1, START = 0
) (
    input  wire clock,
    input  wire here,
    output wire there
);
    generate
        if (CYCLES == 0) begin : direct
            assign there = here;
        end else begin : cable
            reg [CYCLES-1:0] way; initial way = {CYCLES{START != 0}};
            always @(posedge clock) way <= {way, here};
            assign there = way[CYCLES-1];
        end
    endgenerate
endmodule
